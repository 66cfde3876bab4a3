// The names of a VRML text, and how much its nodes multiply. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_SCOPE_H
#define DSPACE_IMPORT_VRML_SCOPE_H

#include <dspace/import/vrml/text/VrmlNodeTable.h>

#include <algorithm>
#include <map>
#include <memory>
#include <string>
#include <unordered_map>

namespace dspace {

// How many nodes a node stands for once every USE and PROTO is followed, and how deep they nest.
struct VrmlWeight {
  double nodes = 0.0;
  int depth = 0;
  std::map<std::string, double> references; // interface field -> how often its value appears

  void Add(const VrmlWeight& child, double times = 1.0) {
    this->nodes += times * child.nodes;
    this->depth = std::max(this->depth, child.depth);
    for (const auto& [field, count] : child.references) {
      this->references[field] += times * count;
    }
  }
};

struct VrmlInterfaceField {
  VrmlFieldType type;
  std::string emitted; // empty: an event, which nothing is made of
};

struct VrmlProto {
  std::string emitted; // empty: external, instances are left out
  std::unordered_map<std::string, VrmlInterfaceField> interface;
  VrmlWeight weight;
};

struct VrmlDefinition {
  std::string emitted; // empty: a node that was left out
  bool open = true;    // its closing brace was not reached yet
  VrmlWeight weight;
};

// Names of a file or of one PROTO's body.
struct VrmlScope {
  std::unordered_map<std::string, VrmlDefinition> definitions;
  std::unordered_map<std::string, std::shared_ptr<VrmlProto>> protos;
  VrmlScope* outer = nullptr;
  VrmlProto* proto = nullptr; // whose body this is

  std::shared_ptr<VrmlProto> FindProto(const std::string& name) const {
    for (const VrmlScope* scope = this; scope; scope = scope->outer) {
      const auto found = scope->protos.find(name);
      if (found != scope->protos.end()) {
        return found->second;
      }
    }
    return nullptr;
  }
};

} // namespace dspace

#endif
