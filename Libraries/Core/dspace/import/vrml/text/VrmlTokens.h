// The words of a VRML text, one by one, with their lines. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_TOKENS_H
#define DSPACE_IMPORT_VRML_TOKENS_H

#include <string>
#include <string_view>

namespace dspace {

struct VrmlToken {
  enum class Kind { End, Word, String, OpenBrace, CloseBrace, OpenBracket, CloseBracket };
  Kind kind = Kind::End;
  std::string_view text; // of a string, with its quotes
  int line = 0;
};

// Splits a text that outlives it. Comments, white space and commas separate.
class VrmlTokens {
public:
  // `path` is for errors; `firstLine` is the number of the text's first line.
  VrmlTokens(std::string_view text, const std::string& path, int firstLine);

  const VrmlToken& Peek() const { return this->Next_; }
  VrmlToken Take();
  bool AtWord(std::string_view word) const {
    return this->Next_.kind == VrmlToken::Kind::Word && this->Next_.text == word;
  }
  bool At(VrmlToken::Kind kind) const { return this->Next_.kind == kind; }

  // Takes a token of that kind, or throws Error(Corrupt): "line 12: found 'x' where a name ...".
  VrmlToken Expect(VrmlToken::Kind kind, const char* what);
  [[noreturn]] void Fail(const std::string& message) const; // at the next token's line

  // Takes an opening brace or bracket and all up to its partner.
  void SkipBalanced();

private:
  void Scan();

  std::string_view Text_;
  std::string Path_;
  std::size_t Position_ = 0;
  int Line_ = 1;
  VrmlToken Next_;
};

// The number that `text` is, wholly; false when it is none or not finite in single precision.
bool ParseVrmlNumber(std::string_view text, double& value);
// Decimal or 0x..., -2147483648 to 4294967295.
bool ParseVrmlInteger(std::string_view text, long long& value);

} // namespace dspace

#endif
