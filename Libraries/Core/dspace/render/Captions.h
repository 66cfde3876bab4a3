// Text captions over a picture that follow its content.
#ifndef DSPACE_RENDER_CAPTIONS_H
#define DSPACE_RENDER_CAPTIONS_H

#include <array>
#include <map>
#include <string>
#include <vector>

#include "vtkSmartPointer.h"

#include <dspace/overlay/PictureBox.h>

class vtkRenderer;
class vtkTextActor;

namespace dspace {

struct Caption {
  std::string text;                           // of characters that DejaVu Sans Mono has, one line
  std::array<double, 2> at = {0, 0};          // its middle, in pixels of the picture
  int fontSize = 13;                          // pixels
  std::array<double, 4> color = {1, 1, 1, 1}; // sRGB and opacity, 0 to 1
  std::array<double, 4> background = {0, 0, 0, 0.5}; // of the box behind it
  bool yields = false; // left out where it would lie over a caption before it
};

// Half of the width and height of its box in pixels, for placing captions beside each other.
std::array<double, 2> HalfSize(const Caption& caption);

// Leaves out captions that yield and lie over one before them, of whichever object.
void LeaveOutOverlaps(std::vector<Caption>& captions);

// Leaves out captions that would lie on one of the boxes, of tables and colour bars.
void LeaveOutCovered(std::vector<Caption>& captions, const std::vector<PictureBox>& boxes);

// The captions of one viewport's picture, on its overlay renderer.
class CaptionActors {
public:
  // Shows exactly these captions. Captions with the same text are moved, not rendered again.
  // `height` is the picture's.
  void Show(const std::vector<Caption>& captions, vtkRenderer* overlay, int height);

private:
  std::multimap<std::string, vtkSmartPointer<vtkTextActor>> Shown_; // by look and text
};

} // namespace dspace

#endif
