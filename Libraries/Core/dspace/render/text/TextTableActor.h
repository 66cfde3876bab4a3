// A TextTable as VTK draws it.
#ifndef DSPACE_RENDER_TEXT_TABLE_ACTOR_H
#define DSPACE_RENDER_TEXT_TABLE_ACTOR_H

#include <vector>

#include "vtkSmartPointer.h"

#include <dspace/overlay/Overlay.h>

class vtkTextActor;

namespace dspace {

// A monospaced block of text, values aligned in a column, on the table's background, placed in its
// corner of a picture of the given size: first what is in the text's colour, with the background,
// then for each other colour of values the same block with blanks for all else.
std::vector<vtkSmartPointer<vtkTextActor>> MakeTextTableActors(const TextTable& table, int width,
                                                               int height);

} // namespace dspace

#endif
