#include "VrmlGuard.h"

#include "ImportFile.h"
#include "VrmlNodeTable.h"
#include "VrmlTokens.h"

#include <dspace/Error.h>

#include <algorithm>
#include <cctype>
#include <map>
#include <memory>

namespace dspace {

namespace {

using Kind = VrmlToken::Kind;
using Base = VrmlFieldType::Base;

constexpr int MaximumDepth = 256;
constexpr double MaximumNodes = 1e6;
constexpr double MaximumCopies = 2e5;
constexpr long long MaximumPixelTextureSide = 16384;

// How many nodes a node stands for once every USE and PROTO is followed, and how deep they nest.
struct Weight {
  double nodes = 0.0;
  int depth = 0;
  std::map<std::string, double> references; // interface field -> how often its value appears

  void Add(const Weight& child, double times = 1.0) {
    this->nodes += times * child.nodes;
    this->depth = std::max(this->depth, child.depth);
    for (const auto& [field, count] : child.references) {
      this->references[field] += times * count;
    }
  }
};

struct InterfaceField {
  VrmlFieldType type;
  std::string emitted; // empty: an event, which nothing is made of
};

struct Proto {
  std::string emitted; // empty: external, instances are left out
  std::unordered_map<std::string, InterfaceField> interface;
  Weight weight;
};

struct Definition {
  std::string emitted; // empty: a node that was left out
  bool open = true;    // its closing brace was not reached yet
  Weight weight;
};

// Names of a file or of one PROTO's body.
struct Scope {
  std::unordered_map<std::string, Definition> definitions;
  std::unordered_map<std::string, std::shared_ptr<Proto>> protos;
  Scope* outer = nullptr;
  Proto* proto = nullptr; // whose body this is

  std::shared_ptr<Proto> FindProto(const std::string& name) const {
    for (const Scope* scope = this; scope; scope = scope->outer) {
      const auto found = scope->protos.find(name);
      if (found != scope->protos.end()) {
        return found->second;
      }
    }
    return nullptr;
  }
};

class Guard {
public:
  Guard(const VrmlText& text, const std::string& path)
      : Dialect_(text.dialect), Path_(path), Tokens_(text.body, path, 1) {
    this->Out_.reserve(text.body.size() + text.header.size() + 16);
    this->Out_ = text.header + "\n";
  }

  GuardedVrml Run(std::vector<std::string>& warnings) {
    Scope scope;
    const Weight weight = this->Statements(scope, Kind::End);
    this->CheckWeight(weight);
    for (const auto& [message, where] : this->Warnings_) {
      const std::string times =
          where.second > 1 ? ", " + std::to_string(where.second) + " times" : "";
      warnings.push_back(message + " (" + FileObject(this->Path_) + ", line " +
                         std::to_string(where.first) + times + ")");
    }
    this->Result_.text = std::move(this->Out_);
    return std::move(this->Result_);
  }

private:
  void Warn(const std::string& message, int line) {
    ++this->Warnings_.emplace(message, std::pair(line, 0)).first->second.second;
  }

  void Emit(std::string_view text) { this->Out_.append(text).push_back(' '); }

  void CheckWeight(const Weight& weight) {
    if (weight.depth > MaximumDepth || this->Nesting_ > MaximumDepth) {
      throw Error(Error::Kind::Resource, FileObject(this->Path_),
                  "line " + std::to_string(this->Tokens_.Peek().line) +
                      ": nodes are nested deeper than " + std::to_string(MaximumDepth));
    }
    if (weight.nodes > MaximumNodes || this->Copies_ > MaximumCopies) {
      throw Error(Error::Kind::Resource, FileObject(this->Path_),
                  "line " + std::to_string(this->Tokens_.Peek().line) +
                      ": USE or PROTO multiply its nodes beyond " +
                      std::to_string(static_cast<int>(
                          weight.nodes > MaximumNodes ? MaximumNodes : MaximumCopies)));
    }
  }

  // Nodes, PROTOs and ROUTEs up to `end`, which is taken. `first`: whether the first node was kept.
  Weight Statements(Scope& scope, Kind end, bool* first = nullptr) {
    Weight weight;
    int count = 0;
    while (!this->Tokens_.At(end)) {
      if (!this->Declaration(scope)) {
        const bool kept = this->NodeStatement(scope, weight);
        if (first && count++ == 0) {
          *first = kept;
          if (!kept) {
            this->Emit("Group { }"); // keeps a PROTO's second node from becoming its first
          }
        }
      }
    }
    this->Tokens_.Take();
    return weight;
  }

  // PROTO, EXTERNPROTO or ROUTE; false when something else comes.
  bool Declaration(Scope& scope) {
    if (this->Dialect_ != VrmlDialect::Vrml2) {
      return false;
    }
    if (this->Tokens_.AtWord("ROUTE")) {
      this->Tokens_.Take();
      for (const char* what : {"'node.event'", "'TO'", "'node.event'"}) {
        this->Tokens_.Expect(Kind::Word, what);
      }
      return true;
    }
    if (this->Tokens_.AtWord("PROTO")) {
      this->ProtoDeclaration(scope);
      return true;
    }
    if (this->Tokens_.AtWord("EXTERNPROTO")) {
      const int line = this->Tokens_.Take().line;
      const std::string name(this->Tokens_.Expect(Kind::Word, "the name of a PROTO").text);
      this->Warn("external PROTO '" + name + "' is not read, its instances are left out", line);
      if (!this->Tokens_.At(Kind::OpenBracket)) {
        this->Tokens_.Fail("EXTERNPROTO needs its interface in brackets");
      }
      this->Tokens_.SkipBalanced();
      if (this->Tokens_.At(Kind::OpenBracket)) {
        this->Tokens_.SkipBalanced();
      } else {
        this->Tokens_.Expect(Kind::String, "the URL of an EXTERNPROTO");
      }
      scope.protos[name] = std::make_shared<Proto>();
      return true;
    }
    return false;
  }

  void ProtoDeclaration(Scope& scope) {
    this->Tokens_.Take();
    const std::string name(this->Tokens_.Expect(Kind::Word, "the name of a PROTO").text);
    auto proto = std::make_shared<Proto>();
    proto->emitted = "P" + std::to_string(this->Serial_++);
    this->Tokens_.Expect(Kind::OpenBracket, "'[' of a PROTO's interface");
    this->Emit("PROTO " + proto->emitted + " [");
    while (!this->Tokens_.At(Kind::CloseBracket)) {
      const VrmlToken access = this->Tokens_.Expect(Kind::Word, "field, exposedField or an event");
      const bool event = access.text == "eventIn" || access.text == "eventOut";
      if (!event && access.text != "field" && access.text != "exposedField") {
        this->Tokens_.Fail("found '" + std::string(access.text) +
                           "' where field, exposedField, eventIn or eventOut is expected");
      }
      InterfaceField field;
      const std::string type(this->Tokens_.Expect(Kind::Word, "the type of a field").text);
      const std::string fieldName(this->Tokens_.Expect(Kind::Word, "the name of a field").text);
      if (!FindVrmlFieldType(type, field.type)) {
        this->Tokens_.Fail("'" + type + "' is no type of a field");
      }
      if (!event) {
        field.emitted = "f" + std::to_string(this->Serial_++);
        this->Emit("field " + type + " " + field.emitted);
        Weight weight;
        this->Value(field.type, scope, weight);
        proto->weight.Add(weight);
        this->CheckWeight(weight);
      }
      proto->interface[fieldName] = field;
    }
    this->Tokens_.Take();
    this->Tokens_.Expect(Kind::OpenBrace, "'{' of a PROTO's body");
    this->Emit("] {");
    Scope body;
    body.outer = &scope;
    body.proto = proto.get();
    ++this->ProtoNesting_;
    ++this->Nesting_;
    this->CheckWeight({});
    bool first = false;
    const std::size_t before = this->Out_.size();
    Weight weight = this->Statements(body, Kind::CloseBrace, &first);
    if (this->Out_.size() == before) {
      this->Emit("Group { }");
    }
    --this->Nesting_;
    --this->ProtoNesting_;
    this->Emit("}\n");
    proto->weight.Add(weight);
    proto->weight.nodes += 1.0;
    proto->weight.depth = weight.depth + 1;
    this->CheckWeight(proto->weight);
    scope.protos[name] = proto;
  }

  // A node, with DEF, or USE. Adds its weight to the parent's; false when it was left out.
  bool NodeStatement(Scope& scope, Weight& parent) {
    if (this->Tokens_.AtWord("USE")) {
      const int line = this->Tokens_.Take().line;
      const std::string name(this->Tokens_.Expect(Kind::Word, "a name to USE").text);
      const auto found = scope.definitions.find(name);
      if (found == scope.definitions.end()) {
        this->Warn("USE of the unknown name '" + name + "' is left out", line);
        return false;
      }
      if (found->second.open) {
        this->Tokens_.Fail("'" + name + "' is used inside itself");
      }
      if (found->second.emitted.empty()) {
        return false;
      }
      parent.Add(found->second.weight);
      this->CheckWeight(parent);
      this->Emit("USE " + found->second.emitted);
      return true;
    }
    std::string name;
    if (this->Tokens_.AtWord("DEF")) {
      this->Tokens_.Take();
      name = this->Tokens_.Expect(Kind::Word, "a name to DEF").text;
    }
    const VrmlToken type = this->Tokens_.Expect(Kind::Word, "the type of a node");
    if (!this->Tokens_.At(Kind::OpenBrace)) {
      this->Tokens_.Expect(Kind::OpenBrace, ("'{' after '" + std::string(type.text) + "'").c_str());
    }
    return this->Node(std::string(type.text), name, type.line, scope, parent);
  }

  bool Node(const std::string& type, const std::string& name, int line, Scope& scope,
            Weight& parent) {
    const std::shared_ptr<Proto> proto = scope.FindProto(type);
    const VrmlNodeType* known = proto ? nullptr : FindVrmlNodeType(this->Dialect_, type);
    if ((proto && proto->emitted.empty()) ||
        (!proto && (!known || known->use != VrmlNodeType::Use::Kept))) {
      if (!proto && (!known || known->use == VrmlNodeType::Use::Unsupported)) {
        this->Warn(std::string(known ? "" : "unknown ") + "node " + type + " is not read", line);
      }
      this->Tokens_.SkipBalanced();
      if (!name.empty()) {
        scope.definitions[name] = {"", false, {}};
      }
      return false;
    }
    const bool texture = this->Dialect_ == VrmlDialect::Vrml1 && type == "Texture2";
    std::string emitted;
    if (!name.empty() || texture) {
      emitted = "D" + std::to_string(this->Serial_++);
      this->Emit("DEF " + emitted);
    }
    if (!name.empty()) {
      this->Result_.names[emitted] = name;
      scope.definitions[name] = {emitted, true, {}};
    }
    this->Emit(proto ? proto->emitted : TypeForCoin(type));
    this->Tokens_.Take();
    this->Emit("{");
    ++this->Nesting_;
    Weight weight;
    if (proto) {
      this->InstanceBody(*proto, type, scope, weight);
    } else {
      this->NodeBody(*known, type, emitted, scope, weight);
    }
    --this->Nesting_;
    this->Emit("}\n");
    weight.nodes += 1.0;
    weight.depth += 1;
    this->CheckWeight(weight);
    parent.Add(weight);
    if (!name.empty()) {
      Definition& definition = scope.definitions[name];
      definition.open = false;
      definition.emitted = emitted;
      definition.weight = weight;
    }
    return true;
  }

  // Coin opens what File and ImageTexture name while it parses; their stand-ins, which have the
  // same fields, only keep the names.
  static std::string TypeForCoin(const std::string& type) {
    return type == "File" ? "WWWInline" : type == "ImageTexture" ? "MovieTexture" : type;
  }

  void InstanceBody(const Proto& proto, const std::string& type, Scope& scope, Weight& weight) {
    std::map<std::string, Weight> values;
    while (!this->Tokens_.At(Kind::CloseBrace)) {
      const VrmlToken name = this->Tokens_.Expect(Kind::Word, "a field or '}'");
      const auto found = proto.interface.find(std::string(name.text));
      this->CheckWeight({});
      if (found == proto.interface.end() || found->second.emitted.empty()) {
        this->SkipField(type, name, found != proto.interface.end());
        continue;
      }
      values[found->second.emitted] = {};
      this->Field(found->second.type, found->second.emitted, type, scope,
                  values[found->second.emitted]);
    }
    this->Tokens_.Take();
    weight.nodes += proto.weight.nodes;
    weight.depth = proto.weight.depth;
    for (const auto& [field, value] : values) {
      const auto count = proto.weight.references.find(field);
      Weight inserted = value;
      inserted.depth += proto.weight.depth;
      // Coin keeps a value once even where the body does not refer to it.
      weight.Add(inserted,
                 count == proto.weight.references.end() ? 1.0 : std::max(1.0, count->second));
    }
    if (this->ProtoNesting_ == 0) {
      this->Copies_ += weight.nodes;
    }
  }

  void NodeBody(const VrmlNodeType& known, const std::string& type, const std::string& emitted,
                Scope& scope, Weight& weight) {
    while (!this->Tokens_.At(Kind::CloseBrace)) {
      this->CheckWeight({});
      if (this->Declaration(scope)) {
        continue;
      }
      if (known.group && (this->Tokens_.AtWord("DEF") || this->Tokens_.AtWord("USE"))) {
        this->NodeStatement(scope, weight);
        continue;
      }
      const VrmlToken name = this->Tokens_.Expect(Kind::Word, "a field, a node or '}'");
      if (known.group && this->Tokens_.At(Kind::OpenBrace)) {
        this->Node(std::string(name.text), "", name.line, scope, weight);
        continue;
      }
      const auto field = known.fields.find(std::string(name.text));
      if (field == known.fields.end()) {
        this->SkipField(type, name, false);
      } else if (type == "Texture2" && name.text == "filename") {
        const std::string_view quoted =
            this->Tokens_.At(Kind::Word)
                ? this->Tokens_.Take().text
                : this->Tokens_.Expect(Kind::String, "the name of a texture").text;
        this->Result_.textures[emitted] = Unquote(quoted);
      } else if (!field->second.kept) {
        const std::size_t before = this->Out_.size();
        this->Field(field->second, "", type, scope, weight);
        this->Out_.resize(before);
      } else {
        this->Field(field->second, std::string(name.text), type, scope, weight);
      }
    }
    this->Tokens_.Take();
  }

  static std::string Unquote(std::string_view quoted) {
    if (quoted.size() < 2 || quoted[0] != '"') {
      return std::string(quoted);
    }
    std::string text;
    for (std::size_t i = 1; i + 1 < quoted.size(); ++i) {
      i += quoted[i] == '\\' && i + 2 < quoted.size();
      text.push_back(quoted[i]);
    }
    return text;
  }

  // A field after its name: IS and an interface field, or a value.
  void Field(const VrmlFieldType& type, const std::string& emitted, const std::string& node,
             Scope& scope, Weight& weight) {
    const int line = this->Tokens_.Peek().line;
    if (!this->Tokens_.AtWord("IS")) {
      const std::size_t before = this->Out_.size();
      this->Emit(emitted);
      if (!this->Value(type, scope, weight)) {
        this->Out_.resize(before); // an empty field: its default holds
      }
      return;
    }
    this->Tokens_.Take();
    const std::string name(this->Tokens_.Expect(Kind::Word, "the name of an interface field").text);
    if (!scope.proto) {
      this->Tokens_.Fail("IS stands outside of a PROTO");
    }
    const auto found = scope.proto->interface.find(name);
    if (found == scope.proto->interface.end() || found->second.type.name != type.name) {
      this->Warn("a field of " + node + " IS '" + name + "', which is no field of type " +
                     type.name + " of the PROTO: left out",
                 line);
    } else if (!found->second.emitted.empty()) {
      this->Emit(emitted);
      this->Emit("IS " + found->second.emitted);
      weight.references[found->second.emitted] += 1.0;
    }
  }

  // Takes a value of that type; false, with nothing emitted, when it is to be left to its default.
  bool Value(const VrmlFieldType& type, Scope& scope, Weight& weight) {
    if (type.base == Base::Node) {
      return this->NodeValue(type, scope, weight);
    }
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
          this->Warn("a list whose length is no multiple of " + std::to_string(type.arity) +
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

  bool NodeValue(const VrmlFieldType& type, Scope& scope, Weight& weight) {
    if (type.many) {
      this->Emit("[");
      if (this->Tokens_.At(Kind::OpenBracket)) {
        this->Tokens_.Take();
        while (!this->Tokens_.At(Kind::CloseBracket)) {
          if (this->Tokens_.AtWord("NULL")) {
            this->Tokens_.Take();
          } else if (!this->Declaration(scope)) {
            this->NodeStatement(scope, weight);
          }
        }
        this->Tokens_.Take();
      } else if (this->Tokens_.AtWord("NULL")) {
        this->Tokens_.Take();
      } else {
        this->NodeStatement(scope, weight);
      }
      this->Emit("]\n");
      return true;
    }
    if (this->Tokens_.AtWord("NULL")) {
      this->Tokens_.Take();
      this->Emit("NULL");
    } else if (!this->NodeStatement(scope, weight)) {
      this->Emit("NULL");
    }
    return true;
  }

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
    this->Tokens_.Fail("found '" + std::string(token.text.substr(0, 60)) + "' where " + what +
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
        this->Tokens_.Fail("'" + std::string(token.text.substr(0, 60)) + "' is not a word");
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

  // A field that nothing is known of, whatever its value looks like.
  void SkipField(const std::string& node, const VrmlToken& name, bool event) {
    VrmlTokens& in = this->Tokens_;
    double number = 0.0;
    const bool silent = event || in.AtWord("IS");
    if (in.At(Kind::OpenBracket) || in.At(Kind::OpenBrace)) {
      in.SkipBalanced();
      if (name.text == "fields" || name.text == "isA") {
        return; // how VRML 1.0 describes extension nodes
      }
    } else if (in.At(Kind::String)) {
      while (in.At(Kind::String)) {
        in.Take();
      }
    } else if (in.AtWord("IS") || in.AtWord("USE")) {
      in.Take();
      in.Expect(Kind::Word, "a name");
    } else if (in.At(Kind::Word) && ParseVrmlNumber(in.Peek().text, number)) {
      while (in.At(Kind::Word) && ParseVrmlNumber(in.Peek().text, number)) {
        in.Take();
      }
    } else {
      if (in.AtWord("DEF")) {
        in.Take();
        in.Expect(Kind::Word, "a name to DEF");
      }
      in.Expect(Kind::Word,
                ("the value of '" + std::string(name.text.substr(0, 60)) + "'").c_str());
      if (in.At(Kind::OpenBrace)) {
        in.SkipBalanced();
      }
    }
    if (!silent) {
      this->Warn("unknown field '" + std::string(name.text) + "' of " + node + " is left out",
                 name.line);
    }
  }

  VrmlDialect Dialect_;
  std::string Path_;
  VrmlTokens Tokens_;
  std::string Out_;
  GuardedVrml Result_;
  std::map<std::string, std::pair<int, int>> Warnings_; // message -> first line, times
  long Serial_ = 0;
  int Nesting_ = 0;
  int ProtoNesting_ = 0;
  double Copies_ = 0.0;
};

} // namespace

GuardedVrml GuardVrml(const VrmlText& text, const std::string& path,
                      std::vector<std::string>& warnings) {
  return Guard(text, path).Run(warnings);
}

} // namespace dspace
