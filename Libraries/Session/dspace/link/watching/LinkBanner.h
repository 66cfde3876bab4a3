// What the viewports of somebody who watches say while the simulation or the server is gone.
#ifndef DSPACE_SESSION_LINK_BANNER_H
#define DSPACE_SESSION_LINK_BANNER_H

#include <map>
#include <string>

#include <dspace/interpreter/Interpreter.h>

namespace dspace::session {

// A line of text at the bottom of each viewport, or at the top where tables or colour bars are at
// the bottom; short where they are at both, and smaller or short where the viewport is narrow.
class LinkBanner {
public:
  LinkBanner() = default;
  ~LinkBanner();
  LinkBanner(const LinkBanner&) = delete;
  LinkBanner& operator=(const LinkBanner&) = delete;

  struct Text {
    std::string full; // empty: there is nothing to say
    std::string brief;
  };
  static Text ServerLost();
  static Text SimulationGone(const std::string& name);

  // From now on it is this interpreter's viewports, of which it hears from its beginning on. It
  // must be there until the next one is followed, or the banner is gone, which then hears no more
  // of it.
  void Follow(Interpreter& interpreter);
  // In every viewport; where it says so already nothing is done.
  void Show(Interpreter& interpreter, const Text& text);

private:
  struct View {
    std::map<std::string, int> corners; // of tables and colour bars, by kind and name
    std::string shown;                  // the table, serialized; empty: none
  };
  void OnCommand(const v1::Command& command);
  void Detach();
  static v1::SetTextTable Make(const View& view, int width, const Text& text);

  std::map<std::string, View> Views_;
  Interpreter* Followed_ = nullptr;
  Interpreter::Token Token_ = 0; // of the listener there
};

} // namespace dspace::session

#endif
