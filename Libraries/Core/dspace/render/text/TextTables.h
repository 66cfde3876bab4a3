// The text tables of one viewport, on its overlay renderer.
#ifndef DSPACE_RENDER_TEXT_TABLES_H
#define DSPACE_RENDER_TEXT_TABLES_H

#include <map>
#include <string>
#include <vector>

#include "vtkSmartPointer.h"

#include <dspace/overlay/Overlay.h>

class vtkRenderer;
class vtkTextActor;

namespace dspace {

// Each stands in a corner of the picture. Functions return whether the picture has changed.
class TextTables {
public:
  // Creates or replaces, by name; false where the same table was there. `width` and `height` are
  // the picture's. Throws Error(InvalidArgument) naming the table and the value.
  bool Set(const TextTable& table, vtkRenderer* overlay, int width, int height);
  bool Remove(const std::string& name, vtkRenderer* overlay); // false where there is none
  // Places all of them in the corners of a picture of another size.
  void Resize(vtkRenderer* overlay, int width, int height);
  // Draws all of them over everything else in the overlay, in the order of their names, so that a
  // picture does not depend on the order in which they were set.
  void Raise(vtkRenderer* overlay) const;

private:
  struct Placed {
    TextTable table;
    std::vector<vtkSmartPointer<vtkTextActor>> actors;
  };
  static void Place(Placed& placed, vtkRenderer* overlay, int width, int height);
  static void RemoveActors(const Placed& placed, vtkRenderer* overlay);
  std::map<std::string, Placed> Placed_;
};

} // namespace dspace

#endif
