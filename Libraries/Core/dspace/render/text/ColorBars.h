// The colour bars of one viewport, on its overlay renderer.
#ifndef DSPACE_RENDER_COLOR_BARS_H
#define DSPACE_RENDER_COLOR_BARS_H

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "vtkSmartPointer.h"

#include <dspace/overlay/ColorBar.h>
#include <dspace/overlay/PictureBox.h>

class vtkProp;
class vtkRenderer;

namespace dspace {

// Each stands in a corner of the picture. Functions return whether the picture has changed.
class ColorBars {
public:
  // Creates or replaces, by name; false where the same bar was there. `width` and `height` are the
  // picture's. Throws Error(InvalidArgument) naming the bar and the value.
  bool Set(const ColorBar& bar, vtkRenderer* overlay, int width, int height);
  bool Remove(const std::string& name, vtkRenderer* overlay); // false where there is none
  // Places all of them in the corners of a picture of another size.
  void Resize(vtkRenderer* overlay, int width, int height);
  // Shows those that `shown` is true for, and hides the others.
  void ShowIf(const std::function<bool(const ColorBar&)>& shown) const;
  // What those that are shown cover of a picture of this size.
  std::vector<PictureBox> Covered(int width, int height) const;
  // Draws all of them over everything else in the overlay, in the order of their names, so that a
  // picture does not depend on the order in which they were set.
  void Raise(vtkRenderer* overlay) const;

private:
  struct Placed {
    ColorBar bar;
    std::vector<vtkSmartPointer<vtkProp>> props;
  };
  std::map<std::string, Placed> Placed_;
};

} // namespace dspace

#endif
