#include <dspace/link/watching/LinkBanner.h>

#include <algorithm>

namespace dspace::session {
namespace {

constexpr const char* Name = LinkBanner::TableName;
constexpr int Margin = 8;               // pixels
constexpr double Advance = 0.61;        // of a letter, of the font's size
constexpr std::size_t LongestName = 40; // bytes of a simulation's name that are shown

// Characters, and the blanks at both ends.
int Letters(const std::string& text) {
  return 2 +
         int(std::count_if(text.begin(), text.end(), [](char c) { return (c & 0xc0) != 0x80; }));
}

// The size at which the text fits, at most 14 pixels.
int FittingSize(const std::string& text, int width) {
  return std::min(14, int((width - 2 * Margin) / (Advance * Letters(text))));
}

std::string Cut(const std::string& name) {
  if (name.size() <= LongestName) {
    return name;
  }
  std::size_t end = LongestName;
  while (end > 0 && (name[end] & 0xc0) == 0x80) { // not within a character
    --end;
  }
  return name.substr(0, end) + "...";
}

} // namespace

LinkBanner::Text LinkBanner::ServerLost() {
  return {"SERVER LOST: last state; waiting for it", "SERVER LOST"};
}

LinkBanner::Text LinkBanner::SimulationGone(const std::string& name) {
  return {"SIMULATION '" + Cut(name) + "' HAS GONE: last state", "SIMULATION GONE"};
}

LinkBanner::~LinkBanner() {
  this->Detach();
}

void LinkBanner::Detach() {
  if (this->Followed_) {
    this->Followed_->RemoveListener(this->Token_);
    this->Followed_ = nullptr;
  }
}

void LinkBanner::Follow(Interpreter& interpreter) {
  this->Detach();
  this->Views_.clear();
  this->Followed_ = &interpreter;
  this->Token_ = interpreter.AddListener(
      [this](const v1::Command& command, const v1::Reply&) { this->OnCommand(command); });
}

void LinkBanner::OnCommand(const v1::Command& command) {
  const auto corner = [](const auto& set) {
    return set.has_anchor() ? int(set.anchor()) : int(v1::SetTextTable::BOTTOM_RIGHT);
  };
  switch (command.command_case()) {
  case v1::Command::kCreateViewport:
    this->Views_[command.create_viewport().name()] = {};
    break;
  case v1::Command::kRemoveViewport:
    this->Views_.erase(command.remove_viewport().viewport());
    break;
  case v1::Command::kSetTextTable: {
    const v1::SetTextTable& set = command.set_text_table();
    if (set.name() != Name) {
      this->Views_[set.viewport()].corners["table " + set.name()] = set.anchor();
    }
    break;
  }
  case v1::Command::kRemoveTextTable:
    this->Views_[command.remove_text_table().viewport()].corners.erase(
        "table " + command.remove_text_table().name());
    break;
  case v1::Command::kSetColorBar:
    this->Views_[command.set_color_bar().viewport()]
        .corners["bar " + command.set_color_bar().name()] = corner(command.set_color_bar());
    break;
  case v1::Command::kRemoveColorBar:
    this->Views_[command.remove_color_bar().viewport()].corners.erase(
        "bar " + command.remove_color_bar().name());
    break;
  default:
    break;
  }
}

v1::SetTextTable LinkBanner::Make(const View& view, int width, const Text& text) {
  using Table = v1::SetTextTable;
  Table table;
  table.set_name(Name);
  const auto free = [&](int corner) {
    return std::none_of(view.corners.begin(), view.corners.end(),
                        [&](const auto& each) { return each.second == corner; });
  };
  // Where nothing is beside it there is room for all of it.
  bool whole = true;
  if (free(Table::BOTTOM_LEFT) && free(Table::BOTTOM_RIGHT)) {
    table.set_anchor(Table::BOTTOM_LEFT);
  } else if (free(Table::TOP_LEFT) && free(Table::TOP_RIGHT)) {
    table.set_anchor(Table::TOP_LEFT);
  } else {
    whole = false;
    table.set_anchor(Table::BOTTOM_LEFT); // and there if all are taken
    for (const auto corner :
         {Table::BOTTOM_LEFT, Table::BOTTOM_RIGHT, Table::TOP_RIGHT, Table::TOP_LEFT}) {
      if (free(corner)) {
        table.set_anchor(corner);
        break;
      }
    }
  }
  table.set_title(whole && FittingSize(text.full, width) >= 10 ? text.full : text.brief);
  table.set_font_size(std::uint32_t(std::max(6, FittingSize(table.title(), width))));
  table.set_margin(Margin);
  table.mutable_color()->set_r(1);
  table.mutable_color()->set_g(0.8);
  table.set_background_opacity(0.8);
  return table;
}

void LinkBanner::Show(Interpreter& interpreter, const Text& text) {
  for (auto& [name, view] : this->Views_) {
    v1::Command command;
    if (text.full.empty()) {
      if (!view.shown.empty()) {
        command.mutable_remove_text_table()->set_viewport(name);
        command.mutable_remove_text_table()->set_name(Name);
        interpreter.Execute(command);
        view.shown.clear();
      }
      continue;
    }
    command.mutable_describe_viewport()->set_viewport(name);
    const int width = int(interpreter.Execute(command).viewport_info().width());
    v1::SetTextTable table = Make(view, width, text);
    const std::string wanted = table.SerializeAsString();
    if (wanted == view.shown) {
      continue;
    }
    table.set_viewport(name);
    *command.mutable_set_text_table() = table;
    if (interpreter.Execute(command).has_error()) { // letters that the font lacks
      command.mutable_set_text_table()->set_title(text.brief);
      interpreter.Execute(command);
    }
    view.shown = wanted;
  }
}

} // namespace dspace::session
