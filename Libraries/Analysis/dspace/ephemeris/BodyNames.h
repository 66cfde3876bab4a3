// NAIF's ids of bodies, and their names.
#ifndef DSPACE_ANALYSIS_BODY_NAMES_H
#define DSPACE_ANALYSIS_BODY_NAMES_H

#include <map>
#include <optional>
#include <string>

namespace dspace {

constexpr int BodySun = 10;
constexpr int BodyMoon = 301;

// Built-in names of the Sun, the planets, their barycentres, moons, asteroids and spacecraft that
// are often asked for, and names that are defined (NAIF_BODY_NAME of a text kernel). Case, and
// underscores for blanks, do not matter. A number as text is its own id.
//
// Source: NAIF, "NAIF Integer ID codes".
class BodyNames {
public:
  BodyNames();

  // Throws Error(NotFound).
  int IdOf(const std::string& name) const;
  std::optional<int> Find(const std::string& name) const;
  // "MOON"; the number where there is no name.
  std::string NameOf(int id) const;
  // Replaces a name, and the name of an id. Throws Error(InvalidArgument) for an empty name.
  void Define(const std::string& name, int id);

private:
  std::map<std::string, int> Ids_;
  std::map<int, std::string> Names_;
};

} // namespace dspace

#endif
