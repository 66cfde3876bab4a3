#include <dspace/overlay/Overlay.h>

#include <dspace/overlay/TextCharacters.h>
#include <dspace/overlay/TextLimits.h>

namespace dspace {

void TextTable::Check() const {
  RequireName("text table", this->name);
  const std::string object = "text table '" + this->name + "'";
  Require(this->margin >= 0, object, "margin", this->margin, "0 pixels and more");
  Require(this->fontSize >= 4 && this->fontSize <= 200, object, "font size", this->fontSize,
          "4 to 200 pixels");
  if (2 * this->rows.size() > MaximumTableCells) {
    Reject(object, "it has " + std::to_string(2 * this->rows.size()) + " cells; accepted: up to " +
                       std::to_string(MaximumTableCells));
  }
  // A line break or a tab would push the columns out of line.
  const auto require = [&](const char* what, const std::string& text) {
    RequireTextLength(object, what, text);
    RequirePlainText(object, what, text, false);
  };
  require("its title", this->title);
  std::size_t label = 0;
  std::size_t value = 0;
  for (const auto& row : this->rows) {
    require("a label", row.first);
    require(("the value of " + QuotedText(row.first)).c_str(), row.second);
    label = std::max(label, CharacterCount(row.first));
    value = std::max(value, CharacterCount(row.second));
  }
  // The font is monospaced: a letter is 0.6 of the font size wide, a line about 1.2 high.
  const std::size_t line = std::max(label + value + 2, CharacterCount(this->title)) + 2;
  RequireTextPicture(object, 0.6 * this->fontSize * double(line),
                     1.2 * this->fontSize * double(this->rows.size() + 1));
  for (std::size_t i = 0; i < 4; ++i) {
    RequireFraction(object, "text colour", this->textColor[i]);
    RequireFraction(object, "background colour", this->backgroundColor[i]);
  }
  for (const auto& [row, color] : this->valueColors) {
    if (row >= this->rows.size()) {
      Reject(object, "a colour is for the value of row " + std::to_string(row) +
                         "; accepted: less than its " + std::to_string(this->rows.size()) +
                         " rows");
    }
    for (const double each : color) {
      RequireFraction(object, "colour of a value", each);
    }
  }
}

} // namespace dspace
