#include <dspace/import/vrml/text/VrmlGuard.h>

#include <dspace/import/files/ImportFile.h>
#include <dspace/import/vrml/text/VrmlNodeTable.h>
#include <dspace/import/vrml/text/VrmlScope.h>
#include <dspace/import/vrml/text/VrmlTokens.h>
#include <dspace/import/vrml/text/VrmlValues.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <algorithm>
#include <map>
#include <memory>
#include <set>

namespace dspace {

namespace {

using Kind = VrmlToken::Kind;
using Base = VrmlFieldType::Base;

constexpr int MaximumDepth = 256;
constexpr double MaximumNodes = 1e6;
constexpr double MaximumCopies = 2e5;

class Guard {
public:
  Guard(const VrmlText& text, const std::string& path)
      : Dialect_(text.dialect), Path_(path), Tokens_(text.body, path, 1) {
    this->Out_.reserve(text.body.size() + text.header.size() + 16);
    this->Out_ = text.header + "\n";
  }

  GuardedVrml Run(std::vector<std::string>& warnings) {
    VrmlScope scope;
    const VrmlWeight weight = this->Statements(scope, Kind::End);
    this->CheckWeight(weight);
    this->Warnings_.AppendTo(warnings, this->Path_);
    this->Result_.text = std::move(this->Out_);
    return std::move(this->Result_);
  }

private:
  void Warn(const std::string& message, int line) { this->Warnings_.Add(message, line); }

  void Emit(std::string_view text) { this->Out_.append(text).push_back(' '); }

  void CheckWeight(const VrmlWeight& weight) {
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
  VrmlWeight Statements(VrmlScope& scope, Kind end, bool* first = nullptr) {
    VrmlWeight weight;
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
  bool Declaration(VrmlScope& scope) {
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
      scope.protos[name] = std::make_shared<VrmlProto>();
      return true;
    }
    return false;
  }

  void ProtoDeclaration(VrmlScope& scope) {
    this->Tokens_.Take();
    const std::string name(this->Tokens_.Expect(Kind::Word, "the name of a PROTO").text);
    auto proto = std::make_shared<VrmlProto>();
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
      VrmlInterfaceField field;
      const std::string type(this->Tokens_.Expect(Kind::Word, "the type of a field").text);
      const std::string fieldName(this->Tokens_.Expect(Kind::Word, "the name of a field").text);
      if (!FindVrmlFieldType(type, field.type) || field.type.base == Base::Enum) {
        this->Tokens_.Fail("'" + type + "' is not a type of a field");
      }
      if (!event) {
        field.emitted = "f" + std::to_string(this->Serial_++);
        this->Emit("field " + type + " " + field.emitted);
        VrmlWeight weight;
        if (!this->Value(field.type, scope, weight)) {
          this->Emit("0 0 0"); // an image, the one value that may be left out
        }
        proto->weight.Add(weight);
        this->CheckWeight(weight);
      }
      proto->interface[fieldName] = field;
    }
    this->Tokens_.Take();
    this->Tokens_.Expect(Kind::OpenBrace, "'{' of a PROTO's body");
    this->Emit("] {");
    VrmlScope body;
    body.outer = &scope;
    body.proto = proto.get();
    ++this->ProtoNesting_;
    ++this->Nesting_;
    this->CheckWeight({});
    bool first = false;
    const std::size_t before = this->Out_.size();
    VrmlWeight weight = this->Statements(body, Kind::CloseBrace, &first);
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
  bool NodeStatement(VrmlScope& scope, VrmlWeight& parent) {
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

  bool Node(const std::string& type, const std::string& name, int line, VrmlScope& scope,
            VrmlWeight& parent) {
    const std::shared_ptr<VrmlProto> proto = scope.FindProto(type);
    const VrmlNodeType* known = proto ? nullptr : FindVrmlNodeType(this->Dialect_, type);
    if ((proto && proto->emitted.empty()) ||
        (!proto && (!known || known->use != VrmlNodeType::Use::Kept))) {
      if (!proto && (!known || known->use == VrmlNodeType::Use::Unsupported)) {
        this->Warn(std::string(known ? "" : "unknown ") + "node " + type + " is not read", line);
      } else if (known && known->use == VrmlNodeType::Use::Listed) {
        ++this->Result_.leftOut[type];
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
    VrmlWeight weight;
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
      VrmlDefinition& definition = scope.definitions[name];
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

  void InstanceBody(const VrmlProto& proto, const std::string& type, VrmlScope& scope,
                    VrmlWeight& weight) {
    std::map<std::string, VrmlWeight> values;
    std::set<std::string, std::less<>> given;
    while (!this->Tokens_.At(Kind::CloseBrace)) {
      const VrmlToken name = this->Tokens_.Expect(Kind::Word, "a field or '}'");
      const auto found = proto.interface.find(std::string(name.text));
      this->CheckWeight({});
      if (found == proto.interface.end() || found->second.emitted.empty()) {
        this->SkipField(type, name, found != proto.interface.end());
        continue;
      }
      this->RequireOnce(found->second.type, type, name.text, given);
      values[found->second.emitted] = {};
      this->Field(found->second.type, found->second.emitted, type, scope,
                  values[found->second.emitted]);
    }
    this->Tokens_.Take();
    weight.nodes += proto.weight.nodes;
    weight.depth = proto.weight.depth;
    for (const auto& [field, value] : values) {
      const auto count = proto.weight.references.find(field);
      VrmlWeight inserted = value;
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
                VrmlScope& scope, VrmlWeight& weight) {
    std::set<std::string, std::less<>> given;
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
        continue;
      }
      this->RequireOnce(field->second, type, name.text, given);
      if (type == "Texture2" && name.text == "filename") {
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

  // Coin frees the nodes of a field that is given again, and crashes where one of them is used
  // further on. Fields of other types hold no nodes: there the last value holds.
  void RequireOnce(const VrmlFieldType& field, const std::string& node, std::string_view name,
                   std::set<std::string, std::less<>>& given) const {
    if (field.base == Base::Node && !given.emplace(name).second) {
      this->Tokens_.Fail("field '" + Utf8Beginning(name, 60) + "' of " + node +
                         " is given twice; accepted: once, as it holds nodes");
    }
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
             VrmlScope& scope, VrmlWeight& weight) {
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
  bool Value(const VrmlFieldType& type, VrmlScope& scope, VrmlWeight& weight) {
    if (type.base == Base::Node) {
      return this->NodeValue(type, scope, weight);
    }
    return WriteVrmlValue(type, this->Tokens_, this->Out_, this->Warnings_);
  }

  bool NodeValue(const VrmlFieldType& type, VrmlScope& scope, VrmlWeight& weight) {
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
      in.Expect(Kind::Word, ("the value of '" + Utf8Beginning(name.text, 60) + "'").c_str());
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
  VrmlWarnings Warnings_;
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
