// The notice in a viewer's viewports while the simulation or the server is disconnected.
#ifndef DSPACE_SESSION_LINK_BANNER_H
#define DSPACE_SESSION_LINK_BANNER_H

#include <map>
#include <string>

#include <dspace/interpreter/Interpreter.h>

namespace dspace::session {

// A line of text at the bottom of each viewport, or at the top if tables or colour bars are at the
// bottom. The text is short if they are at both, and smaller or short in a narrow viewport.
class LinkBanner {
public:
  static constexpr const char* TableName = "dspace.link";

  LinkBanner() = default;
  ~LinkBanner();
  LinkBanner(const LinkBanner&) = delete;
  LinkBanner& operator=(const LinkBanner&) = delete;

  struct Text {
    std::string full; // empty: no notice
    std::string brief;
  };
  static Text ServerLost();
  static Text SimulationGone(const std::string& name);

  // Follows the viewports of a new interpreter. The interpreter must outlive the banner or the next
  // call of Follow.
  void Follow(Interpreter& interpreter);
  // Shows the text in every viewport. Does nothing in viewports that show it already.
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
