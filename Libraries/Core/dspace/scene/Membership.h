// Who sees something in a scene, and with what it is shown and hidden.
#ifndef DSPACE_SCENE_MEMBERSHIP_H
#define DSPACE_SCENE_MEMBERSHIP_H

#include <string>

namespace dspace {

// Physical: visible to a real camera. Ornamental: helps only a person.
enum class Nature { Physical, Ornamental };

// The fragment that always exists for a nature.
inline const char* StandardFragment(Nature nature) {
  return nature == Nature::Physical ? "physical" : "ornamental";
}

// Of something that is part of an object and has a fragment of its own: contours on a terrain.
struct Membership {
  Nature nature = Nature::Ornamental;
  std::string fragment = StandardFragment(Nature::Ornamental); // of that nature

  static Membership Physical() { return {Nature::Physical, StandardFragment(Nature::Physical)}; }
};

} // namespace dspace

#endif
