#include <dspace/render/messages/VtkMessages.h>

#include <algorithm>

#include "vtkCallbackCommand.h"
#include "vtkNew.h"
#include "vtkOutputWindow.h"
#include "vtkWeakPointer.h"

#include <dspace/render/messages/VtkErrorTrap.h>

namespace dspace {

// Follows the window when another one is installed.
class VtkMessages::Observer {
public:
  explicit Observer(VtkMessages& messages) {
    this->Command_->SetClientData(&messages);
    this->Command_->SetCallback([](vtkObject*, unsigned long event, void* to, void* text) {
      static_cast<VtkMessages*>(to)->Take(event == vtkCommand::ErrorEvent,
                                          static_cast<const char*>(text));
    });
  }
  Observer(const Observer&) = delete;
  Observer& operator=(const Observer&) = delete;
  ~Observer() { this->Leave(); }

  void Follow(vtkOutputWindow* window) {
    if (this->Window_ != window) {
      this->Leave();
      this->Window_ = window;
      window->AddObserver(vtkCommand::ErrorEvent, this->Command_);
      window->AddObserver(vtkCommand::WarningEvent, this->Command_);
    }
  }

private:
  void Leave() {
    if (this->Window_) {
      this->Window_->RemoveObserver(this->Command_);
    }
  }

  vtkNew<vtkCallbackCommand> Command_;
  vtkWeakPointer<vtkOutputWindow> Window_;
};

VtkMessages::VtkMessages() : Observer_(std::make_unique<Observer>(*this)) {}

VtkMessages::~VtkMessages() = default;

std::vector<std::string> VtkMessages::TakeWarnings() {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  std::vector<std::string> warnings;
  warnings.swap(this->Warnings_);
  return warnings;
}

void VtkMessages::Add(VtkErrorTrap& trap) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Observer_->Follow(vtkOutputWindow::GetInstance());
  this->Traps_[std::this_thread::get_id()].push_back(&trap);
}

void VtkMessages::Remove(VtkErrorTrap& trap) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const auto found = this->Traps_.find(std::this_thread::get_id());
  std::vector<VtkErrorTrap*>& traps = found->second;
  traps.erase(std::find(traps.begin(), traps.end(), &trap));
  if (traps.empty()) {
    this->Traps_.erase(found);
  }
}

std::string VtkMessages::FirstErrorOf(const VtkErrorTrap& trap) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return trap.FirstError_;
}

void VtkMessages::Take(bool error, const char* text) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const auto found = this->Traps_.find(std::this_thread::get_id());
  if (found == this->Traps_.end()) {
    return;
  }
  if (error) {
    std::string& first = found->second.back()->FirstError_;
    first = first.empty() ? text : first;
    return;
  }
  std::string warning = text; // VTK ends its messages by empty lines
  warning.erase(warning.find_last_not_of(" \n\r\t") + 1);
  const bool known =
      std::find(this->Warnings_.begin(), this->Warnings_.end(), warning) != this->Warnings_.end();
  if (!known && this->Warnings_.size() < MaximumWarnings) {
    this->Warnings_.push_back(std::move(warning));
  }
}

} // namespace dspace
