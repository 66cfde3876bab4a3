#include <dspace/import/vrml/text/VrmlValues.h>

#include <dspace/Utf8.h>
#include <dspace/import/files/ImportFile.h>

#include <algorithm>
#include <cctype>

namespace dspace {

namespace {

using Kind = VrmlToken::Kind;
using Base = VrmlFieldType::Base;

constexpr long long MaximumPixelTextureSide = 16384;

class Writer {
public:
  Writer(VrmlTokens& in, std::string& out, VrmlWarnings& warnings)
      : Tokens_(in), Out_(out), Warnings_(warnings) {}

  bool Value(const VrmlFieldType& type) {
    if (!type.many || !this->Tokens_.At(Kind::OpenBracket)) {
      return this->Single(type);
    }
    this->Tokens_.Take();
    this->Emit("[");
    const int line = this->Tokens_.Peek().line;
    std::size_t complete = this->Out_.size();
    for (long count = 1; !this->Tokens_.At(Kind::CloseBracket); ++count) {
      for (int i = 0; i < type.arity; ++i) {
        if (this->Tokens_.At(Kind::CloseBracket)) {
          this->Warn("a list whose length is not a multiple of " + std::to_string(type.arity) +
                         " loses its incomplete last value",
                     line);
          this->Out_.resize(complete);
          break;
        }
        this->Scalar(type);
      }
      complete = this->Out_.size();
      if (count % 16 == 0) {
        this->Out_.push_back('\n'); // Coin counts lines, and long ones are slow to report
      }
    }
    this->Tokens_.Take();
    this->Emit("]");
    return true;
  }

private:
  bool Single(const VrmlFieldType& type) {
    if (type.base == Base::Image) {
      return this->ImageValue();
    }
    for (int i = 0; i < type.arity; ++i) {
      this->Scalar(type);
    }
    return true;
  }

  void Scalar(const VrmlFieldType& type) {
    double number = 0.0;
    long long integer = 0;
    const VrmlToken& token = this->Tokens_.Peek();
    const bool word = token.kind == Kind::Word;
    std::string_view text = token.text;
    switch (type.base) {
    case Base::Number:
      if (!word || !ParseVrmlNumber(text, number)) {
        this->Expected("a finite number");
      }
      text.remove_prefix(text[0] == '+');
      break;
    case Base::Integer:
      if (!word || !ParseVrmlInteger(text, integer) || integer > 2147483647LL) {
        this->Expected("an integer of 32 bits");
      }
      this->Emit(std::to_string(integer));
      this->Tokens_.Take();
      return;
    case Base::Boolean:
      if (text != "TRUE" && text != "FALSE" && text != "0" && text != "1") {
        this->Expected("TRUE or FALSE");
      }
      text = text == "1" ? "TRUE" : text == "0" ? "FALSE" : text;
      break;
    case Base::Enum:
      this->EnumValue();
      return;
    case Base::String:
      if (token.kind != Kind::String) {
        this->Expected("a string in quotes");
      }
      break;
    default:
      this->Expected("a value");
    }
    this->Emit(text);
    this->Tokens_.Take();
  }

  [[noreturn]] void Expected(const std::string& what) {
    const VrmlToken& token = this->Tokens_.Peek();
    this->Tokens_.Fail("found '" + Utf8Beginning(token.text, 60) + "' where " + what +
                       " is expected");
  }

  // A word, or words in parentheses joined by '|'.
  void EnumValue() {
    bool inside = false;
    do {
      const VrmlToken token = this->Tokens_.Expect(Kind::Word, "a word");
      inside = inside || token.text.front() == '(';
      if (!std::all_of(token.text.begin(), token.text.end(), [](unsigned char c) {
            return std::isalnum(c) || c == '_' || c == '(' || c == ')' || c == '|';
          })) {
        this->Tokens_.Fail("'" + Utf8Beginning(token.text, 60) + "' is not a word");
      }
      this->Emit(token.text);
      inside = inside && token.text.back() != ')';
    } while (inside);
  }

  bool ImageValue() {
    const std::size_t before = this->Out_.size();
    const int line = this->Tokens_.Peek().line;
    long long header[3] = {};
    for (long long& value : header) {
      if (!this->Tokens_.At(Kind::Word) || !ParseVrmlInteger(this->Tokens_.Peek().text, value)) {
        this->Expected("width, height and components of an image");
      }
      this->Emit(std::to_string(value));
      this->Tokens_.Take();
    }
    long long expected = 0;
    const bool sensible = header[0] >= 0 && header[0] <= MaximumPixelTextureSide &&
                          header[1] >= 0 && header[1] <= MaximumPixelTextureSide &&
                          header[2] >= 0 && header[2] <= 4;
    if (sensible) {
      expected = header[0] * header[1];
    }
    long long found = 0;
    for (long long pixel = 0;
         this->Tokens_.At(Kind::Word) && ParseVrmlInteger(this->Tokens_.Peek().text, pixel);
         ++found) {
      if (pixel < 0) {
        this->Expected("a pixel");
      }
      this->Emit(std::to_string(pixel));
      this->Tokens_.Take();
    }
    if (!sensible || found != expected || (expected > 0 && header[2] == 0)) {
      this->Warn("an image of " + std::to_string(header[0]) + " x " + std::to_string(header[1]) +
                     " x " + std::to_string(header[2]) + " that has " + std::to_string(found) +
                     " pixels is left out",
                 line);
      this->Out_.resize(before);
      return false;
    }
    return true;
  }

  void Warn(const std::string& message, int line) { this->Warnings_.Add(message, line); }
  void Emit(std::string_view text) { this->Out_.append(text).push_back(' '); }

  VrmlTokens& Tokens_;
  std::string& Out_;
  VrmlWarnings& Warnings_;
};

} // namespace

void VrmlWarnings::AppendTo(std::vector<std::string>& warnings, const std::string& path) const {
  for (const auto& [message, where] : this->Warnings_) {
    std::string place = " (";
    place += FileObject(path);
    place += ", line ";
    place += std::to_string(where.first);
    if (where.second > 1) {
      place += ", ";
      place += std::to_string(where.second);
      place += " times";
    }
    place += ")";
    warnings.emplace_back(message) += place;
  }
}

bool WriteVrmlValue(const VrmlFieldType& type, VrmlTokens& in, std::string& out,
                    VrmlWarnings& warnings) {
  return Writer(in, out, warnings).Value(type);
}

} // namespace dspace
