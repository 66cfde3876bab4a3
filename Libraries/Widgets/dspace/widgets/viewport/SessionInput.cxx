#include <dspace/widgets/viewport/SessionInput.h>

#include <stdexcept>
#include <utility>

#include "vtkDspaceSession.h"

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

std::string Execute(const Executor& execute, const v1::Command& command) {
  const std::string reply = execute(command.SerializeAsString());
  v1::Reply parsed;
  parsed.ParseFromString(reply);
  if (parsed.has_error()) {
    throw std::runtime_error(parsed.error().message());
  }
  return reply;
}

} // namespace

void ConnectToSession(ViewportWidget& widget, vtkDspaceSession* session,
                      const std::string& viewport,
                      std::function<void(const std::string&, const std::string&)> told) {
  ConnectToExecutor(
      widget, [session](const std::string& command) { return session->Execute(command); }, viewport,
      std::move(told));
}

void ConnectToExecutor(ViewportWidget& widget, const Executor& execute, const std::string& viewport,
                       std::function<void(const std::string&, const std::string&)> told) {
  widget.SetResizer([execute, viewport](int width, int height) {
    v1::Command command;
    command.mutable_resize_viewport()->set_viewport(viewport);
    command.mutable_resize_viewport()->set_width(std::uint32_t(width));
    command.mutable_resize_viewport()->set_height(std::uint32_t(height));
    Execute(execute, command);
  });
  widget.SetHandler([execute, viewport, told = std::move(told)](const ViewportInput& input) {
    v1::Command command;
    v1::ViewportEvent& event = *command.mutable_viewport_event();
    event.set_viewport(viewport);
    event.set_type(input.type == ViewportInput::Type::Press     ? v1::ViewportEvent::PRESS
                   : input.type == ViewportInput::Type::Release ? v1::ViewportEvent::RELEASE
                   : input.type == ViewportInput::Type::Wheel   ? v1::ViewportEvent::WHEEL
                   : input.type == ViewportInput::Type::Key     ? v1::ViewportEvent::KEY
                   : input.type == ViewportInput::Type::DoubleClick
                       ? v1::ViewportEvent::DOUBLE_CLICK
                       : v1::ViewportEvent::MOVE);
    event.set_button(static_cast<v1::ViewportEvent::Button>(static_cast<int>(input.button)));
    event.set_x(input.x);
    event.set_y(input.y);
    event.set_wheel(input.wheel);
    event.set_key(input.key);
    event.set_shift(input.shift);
    event.set_control(input.control);
    event.set_alt(input.alt);
    const std::string reply = Execute(execute, command);
    if (told) {
      v1::Reply parsed;
      parsed.ParseFromString(reply);
      if (parsed.has_input() || parsed.has_pick()) {
        told(event.SerializeAsString(), reply);
      }
    }
  });
}

} // namespace dspace::widgets
