// VRML as a tree that tests change: every mutant is balanced text, most of it of the right types.
#ifndef DSPACE_TESTING_VRML_TREES_H
#define DSPACE_TESTING_VRML_TREES_H

#include <algorithm>
#include <cctype>
#include <string>
#include <vector>

#include <dspace/import/vrml/text/VrmlNodeTable.h>

#include "FuzzMutator.h"

namespace dspace::testing {

// A word, or a list in braces or brackets.
struct VrmlTree {
  std::string word; // empty: a list
  char open = 0;    // '{', '[' or 0 for the file
  std::vector<VrmlTree> items;
};

inline void ParseVrmlTree(const std::string& text, std::size_t& at, VrmlTree& into) {
  while (at < text.size()) {
    const char c = text[at];
    if (std::isspace(static_cast<unsigned char>(c)) || c == ',') {
      ++at;
    } else if (c == '#') {
      at = std::min(text.find('\n', at), text.size());
    } else if (c == '{' || c == '[') {
      into.items.push_back({"", c, {}});
      ParseVrmlTree(text, ++at, into.items.back());
    } else if (c == '}' || c == ']') {
      ++at;
      return;
    } else if (c == '"') {
      std::size_t end = at + 1;
      while (end < text.size() && text[end] != '"') {
        end += text[end] == '\\' ? 2 : 1;
      }
      into.items.push_back({text.substr(at, end + 1 - at), 0, {}});
      at = end + 1;
    } else {
      const std::size_t end = std::min(text.find_first_of(" \t\r\n,{}[]#\"", at), text.size());
      into.items.push_back({text.substr(at, end - at), 0, {}});
      at = end;
    }
  }
}

inline void PrintVrmlTree(const VrmlTree& tree, std::string& into) {
  if (!tree.word.empty()) {
    into += tree.word + ' ';
    return;
  }
  into += tree.open ? std::string(1, tree.open) + ' ' : "";
  for (const VrmlTree& item : tree.items) {
    PrintVrmlTree(item, into);
  }
  into += tree.open == '{' ? "}\n" : tree.open == '[' ? "]\n" : "";
}

// Changes a tree by its structure. Words before a list belong to it: "DEF A Shape {...}", "point
// [...]"; those of a field of one value belong to the number of words that its type has.
class VrmlTreeMutator {
public:
  VrmlTreeMutator(FuzzMutator& random, VrmlDialect dialect) : Random_(random), Dialect_(dialect) {}

  std::string Mutate(const std::string& text) {
    const std::string header = text.substr(0, text.find('\n') + 1);
    VrmlTree root;
    std::size_t at = header.size();
    ParseVrmlTree(text, at, root);
    const std::size_t changes = 1 + this->Random_.Below(4);
    for (std::size_t i = 0; i < changes; ++i) {
      this->Change(root);
    }
    std::string out = header;
    PrintVrmlTree(root, out);
    return out;
  }

private:
  static constexpr std::size_t LargestTree = 20000; // words

  static std::size_t SizeOf(const VrmlTree& tree) {
    std::size_t size = 1;
    for (const VrmlTree& item : tree.items) {
      size += SizeOf(item);
    }
    return size;
  }

  static void Lists(VrmlTree& tree, std::vector<VrmlTree*>& into) {
    if (tree.word.empty()) {
      into.push_back(&tree);
      for (VrmlTree& item : tree.items) {
        Lists(item, into);
      }
    }
  }

  VrmlTree& AnyList(VrmlTree& root) {
    std::vector<VrmlTree*> lists;
    Lists(root, lists);
    return *lists[this->Random_.Below(lists.size())];
  }

  // A range of items of a list that belong together: words up to a list, or a few words.
  std::pair<std::size_t, std::size_t> AnyUnit(const VrmlTree& list) {
    const std::size_t start = this->Random_.Below(list.items.size());
    std::size_t end = start + 1;
    while (end < list.items.size() && end < start + 5 && !list.items[end - 1].word.empty()) {
      ++end;
    }
    return {start, end};
  }

  std::string AnyName() {
    static const char* const names[] = {"Body", "Hull", "Paint", "Points", "Part", "A"};
    return names[this->Random_.Below(sizeof names / sizeof *names)];
  }

  std::string AnyNodeType() {
    static const char* const vrml2[] = {"Anchor",
                                        "Billboard",
                                        "Collision",
                                        "Group",
                                        "Transform",
                                        "Switch",
                                        "LOD",
                                        "Inline",
                                        "Shape",
                                        "Appearance",
                                        "Material",
                                        "ImageTexture",
                                        "PixelTexture",
                                        "TextureTransform",
                                        "Box",
                                        "Sphere",
                                        "Cylinder",
                                        "Cone",
                                        "IndexedFaceSet",
                                        "IndexedLineSet",
                                        "PointSet",
                                        "ElevationGrid",
                                        "Extrusion",
                                        "Coordinate",
                                        "Normal",
                                        "Color",
                                        "TextureCoordinate",
                                        "Text",
                                        "FontStyle",
                                        "Script",
                                        "Viewpoint"};
    static const char* const vrml1[] = {
        "Separator",     "TransformSeparator", "Group",       "Switch",
        "LOD",           "WWWInline",          "Transform",   "Rotation",
        "Scale",         "MatrixTransform",    "Coordinate3", "Normal",
        "NormalBinding", "MaterialBinding",    "Material",    "BaseColor",
        "Texture2",      "TextureCoordinate2", "ShapeHints",  "IndexedFaceSet",
        "IndexedLineSet"};
    return this->Dialect_ == VrmlDialect::Vrml2
               ? vrml2[this->Random_.Below(sizeof vrml2 / sizeof *vrml2)]
               : vrml1[this->Random_.Below(sizeof vrml1 / sizeof *vrml1)];
  }

  std::string AnyNumber(bool integer) {
    static const char* const whole[] = {"0", "-1",  "1",          "2",           "3",
                                        "7", "255", "2147483647", "-2147483648", "65536"};
    static const char* const real[] = {"0",    "1",  "-1",     "0.5",   "1e-30",
                                       "1e30", "-0", "3.4e38", "1e-45", "1000"};
    return integer ? whole[this->Random_.Below(10)] : real[this->Random_.Below(10)];
  }

  void AddValue(const VrmlFieldType& type, int depth, std::vector<VrmlTree>& into) {
    switch (type.base) {
    case VrmlFieldType::Base::Node:
      this->AddNode(depth + 1, into);
      break;
    case VrmlFieldType::Base::Boolean:
      into.push_back({this->Random_.Below(2) ? "TRUE" : "FALSE", 0, {}});
      break;
    case VrmlFieldType::Base::String:
    case VrmlFieldType::Base::Enum:
      into.push_back({this->Random_.Below(2) ? "\"text\"" : "\"a.wrl\"", 0, {}});
      break;
    case VrmlFieldType::Base::Image:
      for (const char* word : {"2", "1", "3", "0xff0000", "255"}) {
        into.push_back({word, 0, {}});
      }
      break;
    case VrmlFieldType::Base::Number:
    case VrmlFieldType::Base::Integer:
      for (int i = 0; i < type.arity; ++i) {
        into.push_back({this->AnyNumber(type.base == VrmlFieldType::Base::Integer), 0, {}});
      }
      break;
    }
  }

  void AddField(const VrmlNodeType& type, int depth, std::vector<VrmlTree>& into) {
    std::vector<std::string> names;
    for (const auto& field : type.fields) {
      names.push_back(field.first);
    }
    if (names.empty()) {
      return;
    }
    std::sort(names.begin(), names.end()); // the same on every machine
    const std::string& name = names[this->Random_.Below(names.size())];
    const VrmlFieldType& field = type.fields.at(name);
    into.push_back({name, 0, {}});
    if (field.many) {
      VrmlTree list{"", '[', {}};
      for (std::size_t i = this->Random_.Below(5); i > 0; --i) {
        this->AddValue(field, depth, list.items);
      }
      into.push_back(std::move(list));
    } else {
      this->AddValue(field, depth, into);
    }
  }

  void AddNode(int depth, std::vector<VrmlTree>& into) {
    const std::size_t choice = this->Random_.Below(8);
    if (choice == 0 || depth > 6) {
      into.push_back({"USE", 0, {}});
      into.push_back({this->AnyName(), 0, {}});
      return;
    }
    if (choice == 1) {
      into.push_back({"NULL", 0, {}});
      return;
    }
    if (choice < 4) {
      into.push_back({"DEF", 0, {}});
      into.push_back({this->AnyName(), 0, {}});
    }
    const std::string name = this->AnyNodeType();
    VrmlTree body{"", '{', {}};
    if (const VrmlNodeType* type = FindVrmlNodeType(this->Dialect_, name)) {
      for (std::size_t i = this->Random_.Below(4); i > 0; --i) {
        this->AddField(*type, depth, body.items);
      }
      while (type->group && this->Random_.Below(2)) {
        this->AddNode(depth + 1, body.items);
      }
    }
    into.push_back({name, 0, {}});
    into.push_back(std::move(body));
  }

  void Insert(VrmlTree& list, std::size_t at, const std::vector<VrmlTree>& items) {
    list.items.insert(list.items.begin() + static_cast<std::ptrdiff_t>(at), items.begin(),
                      items.end());
  }

  std::vector<VrmlTree> Copy(VrmlTree& root) {
    VrmlTree& list = this->AnyList(root);
    if (list.items.empty()) {
      return {};
    }
    const auto [begin, end] = this->AnyUnit(list);
    return {list.items.begin() + static_cast<std::ptrdiff_t>(begin),
            list.items.begin() + static_cast<std::ptrdiff_t>(end)};
  }

  void Change(VrmlTree& root) {
    VrmlTree& list = this->AnyList(root);
    const std::size_t place = this->Random_.Below(list.items.size() + 1);
    switch (this->Random_.Below(list.items.empty() ? 2 : 9)) {
    case 0: { // a new node
      std::vector<VrmlTree> node;
      this->AddNode(0, node);
      this->Insert(list, place, node);
      break;
    }
    case 1: // what stands elsewhere: a field given twice, a node within itself, ...
      if (SizeOf(root) < LargestTree) {
        const std::vector<VrmlTree> copy = this->Copy(root);
        this->Insert(list, place, copy);
      }
      break;
    case 2: { // nothing
      const auto [begin, end] = this->AnyUnit(list);
      list.items.erase(list.items.begin() + static_cast<std::ptrdiff_t>(begin),
                       list.items.begin() + static_cast<std::ptrdiff_t>(end));
      break;
    }
    case 3: // the same often
      if (SizeOf(list) * 200 < LargestTree) {
        const std::vector<VrmlTree> items = list.items;
        for (int i = 0; i < 200; ++i) {
          this->Insert(list, list.items.size(), items);
        }
      }
      break;
    case 4: { // a list in itself
      for (std::size_t i = 1 + this->Random_.Below(300);
           i > 0 && SizeOf(list) < 50 && SizeOf(root) < LargestTree; --i) {
        VrmlTree inner = list;
        list.items = {{"children", 0, {}}, {"Group", 0, {}}, std::move(inner)};
      }
      break;
    }
    case 5:
      std::swap(list.items[this->Random_.Below(list.items.size())],
                list.items[this->Random_.Below(list.items.size())]);
      break;
    case 6: { // a name
      std::vector<VrmlTree> items = {{this->Random_.Below(2) ? "DEF" : "USE", 0, {}},
                                     {this->AnyName(), 0, {}}};
      this->Insert(list, place, items);
      break;
    }
    default: { // another word
      VrmlTree& item = list.items[this->Random_.Below(list.items.size())];
      if (!item.word.empty()) {
        item.word =
            this->Random_.Below(4) ? this->AnyNumber(this->Random_.Below(2)) : this->AnyNodeType();
      }
      break;
    }
    }
  }

  FuzzMutator& Random_;
  VrmlDialect Dialect_;
};

} // namespace dspace::testing

#endif
