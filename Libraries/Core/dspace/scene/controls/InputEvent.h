// Mouse and keyboard events, independent of any toolkit.
#ifndef DSPACE_SCENE_INPUT_EVENT_H
#define DSPACE_SCENE_INPUT_EVENT_H

namespace dspace {

// One event of a viewport. Pixel (0, 0) is the centre of the top-left pixel, Y down; a pointer that
// is dragged out of the picture goes on outside these bounds.
struct InputEvent {
  enum class Type { Press, Move, Release, Wheel, Key };
  enum class Button { None, Left, Middle, Right };
  enum class Key { None, Left, Right, Up, Down, Plus, Minus, Frame, Reset };
  Type type = Type::Move;
  double x = 0.0; // pointer, also of wheel and key events
  double y = 0.0;
  Button button = Button::None; // Press, Release
  bool shift = false;
  bool control = false;
  bool alt = false;
  double wheelSteps = 0.0; // Wheel: notches, positive away from the user
  Key key = Key::None;     // Key: pressed or repeated
};

} // namespace dspace

#endif
