#include "vtkDspaceMessageTrap.h"

#include <algorithm>
#include <mutex>
#include <vector>

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkSmartPointer.h"

vtkStandardNewMacro(vtkDspaceMessageTrap);

namespace {

constexpr std::size_t MaximumWarnings = 20;

} // namespace

struct vtkDspaceMessageTrap::Internals {
  vtkNew<vtkCallbackCommand> command;
  vtkSmartPointer<vtkOutputWindow> window; // null: it does not collect
  std::mutex mutex;                        // of what follows
  std::vector<std::string> errors;         // the first one only
  std::vector<std::string> warnings;

  void Take(bool error, std::string text) {
    text.erase(text.find_last_not_of(" \n\r\t") + 1); // VTK ends its messages by empty lines
    const std::lock_guard<std::mutex> lock(this->mutex);
    std::vector<std::string>& to = error ? this->errors : this->warnings;
    const std::size_t most = error ? 1 : MaximumWarnings;
    if (to.size() < most && std::find(to.begin(), to.end(), text) == to.end()) {
      to.push_back(std::move(text));
    }
  }
};

vtkDspaceMessageTrap::vtkDspaceMessageTrap() : Impl(std::make_unique<Internals>()) {
  this->Impl->command->SetClientData(this->Impl.get());
  this->Impl->command->SetCallback([](vtkObject*, unsigned long event, void* to, void* text) {
    static_cast<Internals*>(to)->Take(event == vtkCommand::ErrorEvent,
                                      static_cast<const char*>(text));
  });
}

vtkDspaceMessageTrap::~vtkDspaceMessageTrap() {
  this->End();
}

void vtkDspaceMessageTrap::Begin() {
  this->End();
  this->Impl->errors.clear();
  this->Impl->warnings.clear();
  this->Impl->window = vtkOutputWindow::GetInstance();
  this->Impl->window->AddObserver(vtkCommand::ErrorEvent, this->Impl->command);
  this->Impl->window->AddObserver(vtkCommand::WarningEvent, this->Impl->command);
}

void vtkDspaceMessageTrap::End() {
  if (this->Impl->window) {
    this->Impl->window->RemoveObserver(this->Impl->command);
    this->Impl->window = nullptr;
  }
}

std::string vtkDspaceMessageTrap::GetError() {
  const std::lock_guard<std::mutex> lock(this->Impl->mutex);
  return this->Impl->errors.empty() ? std::string() : this->Impl->errors.front();
}

int vtkDspaceMessageTrap::GetNumberOfWarnings() {
  const std::lock_guard<std::mutex> lock(this->Impl->mutex);
  return int(this->Impl->warnings.size());
}

std::string vtkDspaceMessageTrap::GetWarning(int index) {
  const std::lock_guard<std::mutex> lock(this->Impl->mutex);
  return index >= 0 && std::size_t(index) < this->Impl->warnings.size()
             ? this->Impl->warnings[std::size_t(index)]
             : std::string();
}

void vtkDspaceMessageTrap::PrintSelf(ostream& os, vtkIndent indent) {
  this->Superclass::PrintSelf(os, indent);
  os << indent << "Collecting: " << (this->Impl->window ? "yes" : "no") << "\n"
     << indent << "Error: " << this->GetError() << "\n";
}
