#include <dspace/ephemeris/Fallbacks.h>

#include <algorithm>
#include <cmath>

#include <dspace/time/UtcText.h>

namespace dspace {
namespace {

thread_local FallbackScope* Innermost = nullptr;

} // namespace

FallbackScope::FallbackScope() : Outer_(Innermost) {
  Innermost = this;
}

FallbackScope::~FallbackScope() {
  Innermost = this->Outer_;
}

void FallbackScope::Begin(double tdb) {
  if (Innermost && tdb != Innermost->Time_) {
    Innermost->Time_ = tdb;
    ++Innermost->Times_;
  }
}

void FallbackScope::Note(const std::string& warning) {
  if (!Innermost || warning.empty()) {
    return;
  }
  FallbackScope& scope = *Innermost;
  auto entry = std::find_if(scope.Entries_.begin(), scope.Entries_.end(),
                            [&](const Entry& each) { return each.text == warning; });
  if (entry == scope.Entries_.end()) {
    scope.Entries_.push_back({warning, scope.Times_, 1, scope.Time_, scope.Time_});
    return;
  }
  if (entry->last == scope.Times_) {
    return;
  }
  entry->last = scope.Times_;
  ++entry->count;
  // The first of both is NaN where the text was noted before any time.
  entry->begin = std::fmin(entry->begin, scope.Time_);
  entry->end = std::fmax(entry->end, scope.Time_);
}

std::vector<std::string> FallbackScope::Noted() {
  std::vector<std::string> texts;
  if (Innermost) {
    for (const Entry& entry : Innermost->Entries_) {
      texts.push_back(entry.text);
    }
  }
  return texts;
}

std::vector<std::string> FallbackScope::Warnings(const TimeScales& scales) const {
  std::vector<std::string> out;
  for (const Entry& entry : this->Entries_) {
    std::string text = entry.text;
    if (this->Times_ > 1 && entry.begin <= entry.end) {
      text += " (at " + std::to_string(entry.count) + " of " + std::to_string(this->Times_) +
              " times: " + TimeLabel(entry.begin, scales);
      text += entry.begin < entry.end ? " to " + TimeLabel(entry.end, scales) + ")" : ")";
    }
    out.push_back(std::move(text));
  }
  return out;
}

} // namespace dspace
