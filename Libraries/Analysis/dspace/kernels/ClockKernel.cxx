#include <dspace/kernels/ClockKernel.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <set>

#include <dspace/Checks.h>

namespace dspace {
namespace {

const char* const TypePrefix = "SCLK_DATA_TYPE_";

// The delimiters of field SCLK01_OUTPUT_DELIM, from code 1 on.
const char* const Delimiters[] = {".", ":", "-", ",", " "};

bool IsWhole(double value) {
  return std::isfinite(value) && value == std::floor(value);
}

} // namespace

std::vector<int> ClockKernel::Clocks(const KernelPool& pool) {
  std::set<int> found;
  const std::string prefix = TypePrefix;
  for (auto it = pool.Variables().lower_bound(prefix); it != pool.Variables().end(); ++it) {
    if (it->first.compare(0, prefix.size(), prefix) != 0) {
      break;
    }
    const std::string digits = it->first.substr(prefix.size());
    if (!digits.empty() && digits.size() < 10 &&
        digits.find_first_not_of("0123456789") == std::string::npos) {
      found.insert(-std::atoi(digits.c_str()));
    }
  }
  return {found.begin(), found.end()};
}

std::string ClockKernel::Label() const {
  return "clock " + std::to_string(this->Clock_);
}

void ClockKernel::Fail(const std::string& variable, const std::string& what) const {
  throw Error(Error::Kind::Corrupt, this->Label(), variable + " " + what);
}

ClockKernel::ClockKernel(const KernelPool& pool, int clock, const TimeScales& scales)
    : Clock_(clock), Scales_(scales) {
  const std::string id = std::to_string(-clock);
  if (!pool.Has(TypePrefix + id)) {
    std::string known;
    for (const int other : Clocks(pool)) {
      known += (known.empty() ? "" : ", ") + std::to_string(other);
    }
    throw Error(Error::Kind::NotFound, this->Label(),
                "no loaded SCLK kernel has this clock; " +
                    (known.empty() ? std::string("none is loaded") : "loaded: " + known));
  }
  const int type = pool.Integer(TypePrefix + id);
  if (type != 1) {
    throw Error(Error::Kind::Unsupported, this->Label(),
                "its SCLK kernel is of type " + std::to_string(type) + "; accepted: type 1");
  }
  const auto name = [&](const char* field) { return std::string("SCLK01_") + field + "_" + id; };
  const std::string system = name("TIME_SYSTEM");
  if (pool.Has(system)) {
    const int code = pool.Integer(system);
    if (code != 1 && code != 2) {
      this->Fail(system, "is " + std::to_string(code) + "; accepted: 1 (TDB) or 2 (TDT)");
    }
    this->ParallelIsTt_ = code == 2;
  }
  const int fields = pool.Integer(name("N_FIELDS"));
  if (fields < 1 || fields > 10) {
    this->Fail(name("N_FIELDS"), "is " + std::to_string(fields) + "; accepted: 1 to 10");
  }
  this->Moduli_ = pool.Numbers(name("MODULI"), std::size_t(fields));
  this->Offsets_ = pool.Numbers(name("OFFSETS"), std::size_t(fields));
  double ticks = 1.0;
  for (int i = 0; i < fields; ++i) {
    const double modulus = this->Moduli_[std::size_t(i)];
    if (!IsWhole(modulus) || modulus < 1.0 || !IsWhole(this->Offsets_[std::size_t(i)])) {
      this->Fail(name("MODULI"), "or its offset is no whole number of at least 1");
    }
    ticks *= i > 0 ? modulus : 1.0;
  }
  this->TicksACount_ = ticks;
  if (!(ticks * this->Moduli_[0] < 1e18)) {
    this->Fail(name("MODULI"), "have a product above 1e18");
  }
  const int delimiter = pool.Has(name("OUTPUT_DELIM")) ? pool.Integer(name("OUTPUT_DELIM")) : 1;
  if (delimiter < 1 || delimiter > 5) {
    this->Fail(name("OUTPUT_DELIM"), "is " + std::to_string(delimiter) + "; accepted: 1 to 5");
  }
  this->Delimiter_ = Delimiters[delimiter - 1];

  const std::string starts = "SCLK_PARTITION_START_" + id;
  const std::string ends = "SCLK_PARTITION_END_" + id;
  this->PartitionStarts_ = pool.Numbers(starts);
  const std::vector<double>& last = pool.Numbers(ends, this->PartitionStarts_.size());
  double total = 0.0;
  for (std::size_t i = 0; i < last.size(); ++i) {
    if (!IsWhole(this->PartitionStarts_[i]) || !IsWhole(last[i]) ||
        !(last[i] > this->PartitionStarts_[i])) {
      this->Fail(ends, "does not lie after the partition's start");
    }
    total += last[i] - this->PartitionStarts_[i];
    this->PartitionEnds_.push_back(total);
  }

  const std::string table = name("COEFFICIENTS");
  const std::vector<double>& numbers = pool.Numbers(table);
  if (numbers.size() % 3 != 0) {
    this->Fail(table, "has " + std::to_string(numbers.size()) + " numbers; accepted: triples");
  }
  for (std::size_t i = 0; i < numbers.size(); i += 3) {
    const Record record = {numbers[i], numbers[i + 1], numbers[i + 2]};
    if (!(record.rate > 0.0) || (i > 0 && !(record.ticks > this->Records_.back().ticks &&
                                            record.parallel > this->Records_.back().parallel))) {
      this->Fail(table, "does not ascend at triple " + std::to_string(i / 3 + 1));
    }
    this->Records_.push_back(record);
  }
}

double ClockKernel::TdbOf(double ticks) const {
  if (!(ticks >= 0.0 && ticks <= this->LastTick())) {
    Reject(this->Label(), "the time is " + NumberText(ticks) + " ticks; accepted: 0 to " +
                              NumberText(this->LastTick()));
  }
  auto after = std::upper_bound(this->Records_.begin(), this->Records_.end(), ticks,
                                [](double t, const Record& record) { return t < record.ticks; });
  if (after == this->Records_.begin()) {
    ++after; // before the first record its rate goes on
  }
  const Record& record = *(after - 1);
  const double parallel =
      record.parallel + (ticks - record.ticks) / this->TicksACount_ * record.rate;
  return this->ParallelIsTt_ ? this->Scales_.TdbFromTt(parallel) : parallel;
}

double ClockKernel::TicksOf(double tdb) const {
  RequireFinite(this->Label(), "the time", tdb);
  const double parallel = this->ParallelIsTt_ ? this->Scales_.TtFromTdb(tdb) : tdb;
  auto after = std::upper_bound(this->Records_.begin(), this->Records_.end(), parallel,
                                [](double t, const Record& record) { return t < record.parallel; });
  if (after == this->Records_.begin()) {
    ++after;
  }
  const Record& record = *(after - 1);
  double ticks = record.ticks + (parallel - record.parallel) / record.rate * this->TicksACount_;
  if (after != this->Records_.end()) {
    ticks = std::min(ticks, after->ticks); // where the tabulated pieces overlap
  }
  constexpr double Rounding = 1e-3; // ticks
  if (!(ticks >= -Rounding && ticks <= this->LastTick() + Rounding)) {
    Reject(this->Label(), "the time is " + NumberText(tdb) + " s TDB past J2000; accepted: " +
                              NumberText(this->FirstTdb()) + " to " + NumberText(this->LastTdb()));
  }
  return std::min(std::max(ticks, 0.0), this->LastTick());
}

double ClockKernel::TicksOfText(const std::string& text) const {
  const auto fail = [&](const std::string& what) {
    std::string fields;
    for (std::size_t i = 0; i < this->Moduli_.size(); ++i) {
      fields += (i ? this->Delimiter_ : "") + NumberText(this->Offsets_[i]) + "-" +
                std::to_string((long long)(this->Offsets_[i] + this->Moduli_[i] - 1.0));
    }
    Reject(this->Label(), "the time '" + text + "' " + what +
                              "; accepted: PARTITION/FIELDS, with "
                              "partitions 1 to " +
                              std::to_string(this->PartitionEnds_.size()) + " and fields within " +
                              fields);
  };
  std::size_t at = 0;
  long partition = 0;
  const std::size_t slash = text.find('/');
  if (slash != std::string::npos) {
    const std::string digits = text.substr(0, slash);
    if (digits.empty() || digits.size() > 9 ||
        digits.find_first_not_of("0123456789") != std::string::npos) {
      fail("has no partition before '/'");
    }
    partition = std::atol(digits.c_str());
    if (partition < 1 || partition > long(this->PartitionEnds_.size())) {
      fail("is in no partition of the clock");
    }
    at = slash + 1;
  }
  std::vector<double> counts;
  std::string digits;
  for (; at <= text.size(); ++at) {
    const bool end = at == text.size();
    if (!end && text[at] >= '0' && text[at] <= '9') {
      digits += text[at];
      continue;
    }
    if (!end && std::string(".:-, ").find(text[at]) == std::string::npos) {
      fail("has the character '" + text.substr(at, 1) + "'");
    }
    if (digits.empty()) {
      fail("has an empty field");
    }
    if (digits.size() > 18 || counts.size() == this->Moduli_.size()) {
      fail("has too many fields or digits");
    }
    counts.push_back(std::strtod(digits.c_str(), nullptr));
    digits.clear();
  }
  double ticks = 0.0;
  double unit = this->TicksACount_;
  for (std::size_t i = 0; i < counts.size(); ++i) {
    unit = i == 0 ? this->TicksACount_ : unit / this->Moduli_[i];
    const double count = counts[i] - this->Offsets_[i];
    if (!(count >= 0.0 && count < this->Moduli_[i])) {
      fail("has the field " + NumberText(counts[i]));
    }
    ticks += count * unit;
  }
  for (std::size_t p = 0; p < this->PartitionEnds_.size(); ++p) {
    const double before = p == 0 ? 0.0 : this->PartitionEnds_[p - 1];
    const double into = ticks - this->PartitionStarts_[p];
    const bool inside = into >= 0.0 && into <= this->PartitionEnds_[p] - before;
    if (inside && (partition == 0 || partition == long(p) + 1)) {
      return before + into;
    }
  }
  fail("lies outside its partition");
  return 0.0;
}

std::string ClockKernel::TextOf(double ticks) const {
  this->TdbOf(ticks); // checks the range
  const double whole = std::round(ticks);
  std::size_t p = 0;
  while (p + 1 < this->PartitionEnds_.size() && whole >= this->PartitionEnds_[p]) {
    ++p; // where one ends and the next begins, the next
  }
  double rest = whole - (p == 0 ? 0.0 : this->PartitionEnds_[p - 1]) + this->PartitionStarts_[p];
  std::string out = std::to_string(p + 1) + "/";
  double unit = this->TicksACount_;
  for (std::size_t i = 0; i < this->Moduli_.size(); ++i) {
    unit = i == 0 ? this->TicksACount_ : unit / this->Moduli_[i];
    const double count = std::floor(rest / unit);
    rest -= count * unit;
    char digits[40];
    const double most = this->Moduli_[i] - 1.0 + this->Offsets_[i];
    std::snprintf(digits, sizeof(digits), "%0*.0f", int(std::to_string((long long)most).size()),
                  count + this->Offsets_[i]);
    out += (i ? this->Delimiter_ : "") + digits;
  }
  return out;
}

} // namespace dspace
