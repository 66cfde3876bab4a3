// Mouse and keyboard events, independent of any toolkit.
#ifndef DSPACE_SCENE_INPUT_EVENT_H
#define DSPACE_SCENE_INPUT_EVENT_H

namespace dspace {

// One event of a viewport. Pixel (0, 0) is the centre of the top-left pixel, Y down; a pointer that
// is dragged out of the picture goes on outside these bounds.
struct InputEvent {
  enum class Type { Press, Move, Release, Wheel, Key, DoubleClick };
  enum class Button { None, Left, Middle, Right };
  enum class Key {
    None,
    Left,
    Right,
    Up,
    Down,
    Plus,
    Minus,
    Frame,
    Reset,
    Forward, // of a walk, and the next three
    Backward,
    StepLeft,
    StepRight,
    Cancel
  };
  Type type = Type::Move;
  double x = 0.0; // pointer, also of wheel and key events
  double y = 0.0;
  Button button = Button::None; // Press, Release, DoubleClick
  bool shift = false;
  bool control = false;
  bool alt = false;
  double wheelSteps = 0.0; // Wheel: notches, positive away from the user
  Key key = Key::None;     // Key: pressed or repeated
  double seconds = 0.1;    // Key: how long it has been held since its last event, 0 to 1
};

} // namespace dspace

#endif
