// The VRML nodes and fields that the importer reads, and their types. Internal.
#ifndef DSPACE_IMPORT_VRML_NODE_TABLE_H
#define DSPACE_IMPORT_VRML_NODE_TABLE_H

#include <dspace/import/vrml/text/VrmlText.h>

#include <string>
#include <unordered_map>

namespace dspace {

struct VrmlFieldType {
  enum class Base { Number, Integer, Boolean, String, Node, Image, Enum };
  std::string name; // "SFVec3f"
  Base base = Base::Number;
  int arity = 1;     // numbers a value: 3 for a colour
  bool many = false; // an MF field: a list in brackets, or one value
  bool kept = true;  // else it is checked and left out: nothing is made of it
};

struct VrmlNodeType {
  enum class Use {
    Kept,       // read
    Ignored,    // describes the file, or how it is browsed: left out
    Listed,     // has no geometry but an effect (lights, sensors, ...): left out and counted
    Unsupported // would be seen, is not read: left out with a warning
  };
  Use use = Use::Kept;
  bool group = false; // VRML 1.0: children stand among the fields
  std::unordered_map<std::string, VrmlFieldType> fields;
};

// The type of that name, or null when the dialect has none.
const VrmlNodeType* FindVrmlNodeType(VrmlDialect dialect, const std::string& name);

// A type of a PROTO's interface, "MFVec3f"; false when there is none of that name.
bool FindVrmlFieldType(const std::string& name, VrmlFieldType& type);

} // namespace dspace

#endif
