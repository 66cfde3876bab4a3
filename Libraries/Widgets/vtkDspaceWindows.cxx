#include "vtkDspaceWindows.h"

#include <cstdlib>
#include <deque>
#include <map>
#include <set>
#include <utility>

#include <dlfcn.h>

#include <QApplication>
#include <QMainWindow>
#include <QPointer>
#include <QTimer>

#include "vtkDspaceSession.h"
#include "vtkDspaceViewport.h"
#include "vtkObjectFactory.h"
#include "vtkSmartPointer.h"

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/SessionInput.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

vtkStandardNewMacro(vtkDspaceWindows);

namespace {

// Whether an X server answers at DISPLAY. By the library of Qt's own plug-in: without it, Qt says
// so.
bool CanReachX() {
  void* library = dlopen("libxcb.so.1", RTLD_NOW | RTLD_LOCAL);
  if (!library) {
    return true;
  }
  const auto connect =
      reinterpret_cast<void* (*)(const char*, int*)>(dlsym(library, "xcb_connect"));
  const auto failed = reinterpret_cast<int (*)(void*)>(dlsym(library, "xcb_connection_has_error"));
  const auto disconnect = reinterpret_cast<void (*)(void*)>(dlsym(library, "xcb_disconnect"));
  bool reached = true;
  if (connect && failed && disconnect) {
    void* connection = connect(nullptr, nullptr);
    reached = failed(connection) == 0;
    disconnect(connection);
  }
  dlclose(library);
  return reached;
}

// Why no window can be opened; empty: one can. Qt ends the process where there is no display.
std::string NoDisplay() {
  const std::string platform = qEnvironmentVariable("QT_QPA_PLATFORM").toStdString();
  if (!platform.empty() && platform.rfind("xcb", 0) != 0) {
    return "";
  }
  const auto set = [](const char* name) {
    const char* value = std::getenv(name);
    return value && *value;
  };
  if (set("DISPLAY") && !set("WAYLAND_DISPLAY") && !CanReachX()) {
    return "the display '" + std::string(std::getenv("DISPLAY")) + "' (DISPLAY) cannot be reached";
  }
  if (set("DISPLAY") || set("WAYLAND_DISPLAY")) {
    return "";
  }
  return "there is no display: neither DISPLAY nor WAYLAND_DISPLAY is set";
}

} // namespace

struct vtkDspaceWindows::Internals {
  using Key = std::pair<vtkDspaceSession*, std::string>;
  std::map<Key, QPointer<QMainWindow>> windows;
  std::deque<std::pair<std::string, std::string>> events; // with their replies
  std::string reply;
  std::set<std::string> failures;

  QMainWindow* Find(vtkDspaceSession* session, const std::string& viewport) {
    const auto found = this->windows.find({session, viewport});
    return found == this->windows.end() || !found->second || !found->second->isVisible()
               ? nullptr
               : found->second.data();
  }
  void Forget(const Key& key) {
    const auto found = this->windows.find(key);
    if (found != this->windows.end()) {
      delete found->second.data();
      this->windows.erase(found);
    }
  }
  std::string Start() {
    if (QCoreApplication::instance()) {
      return qobject_cast<QApplication*>(QCoreApplication::instance())
                 ? ""
                 : "the program's QCoreApplication is no QApplication";
    }
    const std::string why = NoDisplay();
    if (!why.empty()) {
      return why;
    }
    static int count = 1;
    static char name[] = "dspace";
    static char* arguments[] = {name, nullptr};
    dspace::widgets::PrepareApplication();
    // It lives as long as the process: other sessions may open windows after this one has ended.
    auto* application = new QApplication(count, arguments);
    application->setQuitOnLastWindowClosed(false);
    return "";
  }
};

vtkDspaceWindows::vtkDspaceWindows() : Impl(std::make_unique<Internals>()) {}

vtkDspaceWindows::~vtkDspaceWindows() {
  while (!this->Impl->windows.empty()) {
    this->Impl->Forget(this->Impl->windows.begin()->first);
  }
}

void vtkDspaceWindows::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Windows: " << this->GetCount() << "\n";
}

std::string vtkDspaceWindows::Show(vtkDspaceSession* session, const std::string& viewport,
                                   const std::string& title, int width, int height) {
  const std::string why = this->Impl->Start();
  if (!why.empty()) {
    return why;
  }
  vtkDspaceViewport* shown = session ? session->GetViewport(viewport) : nullptr;
  if (!shown) {
    return "there is no viewport '" + viewport + "'";
  }
  if (QMainWindow* window = this->Impl->Find(session, viewport)) {
    window->raise();
    window->activateWindow();
    return "";
  }
  this->Impl->Forget({session, viewport});
  try {
    auto window = std::make_unique<QMainWindow>();
    auto* widget = new dspace::widgets::ViewportWidget(shown, window.get());
    dspace::widgets::ConnectToSession(*widget, session, viewport,
                                      [this](const std::string& event, const std::string& reply) {
                                        this->Impl->events.emplace_back(event, reply);
                                      });
    QObject::connect(
        widget, &dspace::widgets::ViewportWidget::failed, window.get(),
        [this](const QString& message) { this->Impl->failures.insert(message.toStdString()); });
    window->setCentralWidget(widget);
    window->setWindowTitle(QString::fromStdString(title));
    window->resize(width > 0 && height > 0 ? QSize(width, height) : widget->sizeHint());
    window->show();
    widget->setFocus();
    this->Impl->windows[{session, viewport}] = window.release();
  } catch (const std::exception& error) {
    return error.what();
  }
  return "";
}

void vtkDspaceWindows::Close(vtkDspaceSession* session, const std::string& viewport) {
  this->Impl->Forget({session, viewport});
}

void vtkDspaceWindows::CloseAll(vtkDspaceSession* session) {
  for (auto it = this->Impl->windows.begin(); it != this->Impl->windows.end();) {
    const Internals::Key key = it->first;
    ++it;
    if (key.first == session) {
      this->Impl->Forget(key);
    }
  }
}

bool vtkDspaceWindows::IsShown(vtkDspaceSession* session, const std::string& viewport) {
  return this->Impl->Find(session, viewport) != nullptr;
}

int vtkDspaceWindows::GetCount() {
  int count = 0;
  for (const auto& entry : this->Impl->windows) {
    count += entry.second && entry.second->isVisible() ? 1 : 0;
  }
  return count;
}

std::string vtkDspaceWindows::ProcessEvents(int milliseconds) {
  if (!QCoreApplication::instance()) {
    return "no window was opened";
  }
  const auto flags = milliseconds > 0 ? QEventLoop::AllEvents | QEventLoop::WaitForMoreEvents
                                      : QEventLoop::AllEvents;
  if (milliseconds > 0) {
    QTimer wake; // so that waiting ends
    wake.setSingleShot(true);
    wake.start(milliseconds);
    QCoreApplication::processEvents(flags);
  } else {
    QCoreApplication::processEvents(flags);
  }
  return "";
}

std::string vtkDspaceWindows::TakeEvent() {
  if (this->Impl->events.empty()) {
    return "";
  }
  const auto taken = this->Impl->events.front();
  this->Impl->events.pop_front();
  this->Impl->reply = taken.second;
  return taken.first;
}

std::string vtkDspaceWindows::TakeReply() {
  return std::exchange(this->Impl->reply, "");
}

std::string vtkDspaceWindows::TakeFailures() {
  std::string all;
  for (const std::string& failure : this->Impl->failures) {
    all += failure + "\n";
  }
  this->Impl->failures.clear();
  return all;
}
