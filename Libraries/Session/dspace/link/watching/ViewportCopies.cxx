#include <dspace/link/watching/ViewportCopies.h>

#include <optional>

#include <dspace/ledger/Ledger.h>
#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/CommandTraits.h>

namespace dspace::session {
namespace {

// Changes the viewport that a command is about.
void Rename(v1::Command& command, const std::string& name) {
  if (command.has_create_viewport()) {
    command.mutable_create_viewport()->set_name(name);
    return;
  }
  const google::protobuf::FieldDescriptor* kind =
      v1::Command::descriptor()->FindFieldByNumber(command.command_case());
  google::protobuf::Message* inner = command.GetReflection()->MutableMessage(&command, kind);
  inner->GetReflection()->SetString(inner, inner->GetDescriptor()->FindFieldByName("viewport"),
                                    name);
}

} // namespace

ViewportCopies::~ViewportCopies() {
  this->Detach();
}

void ViewportCopies::Detach() {
  if (this->Followed_) {
    this->Followed_->RemoveListener(this->Token_);
  }
  this->Followed_ = nullptr;
}

void ViewportCopies::Follow(Interpreter& interpreter) {
  this->Detach();
  this->Ledger_ = {};
  this->Followed_ = &interpreter;
  this->Token_ =
      interpreter.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
        v1::Command recorded;
        if (ToRecorded(command, reply, recorded)) {
          this->Ledger_.Add(recorded);
        }
      });
}

std::vector<v1::Command> ViewportCopies::Commands(const std::string& viewport,
                                                  const std::string& as,
                                                  const std::string& table) const {
  std::vector<v1::Command> all, copies;
  this->Ledger_.Put(
      [this](const std::string& scene) {
        LedgerViewports::SceneView view{{}, [](const std::string&) { return 0u; }};
        const auto& scenes = this->Followed_->GetState().scenes;
        const auto found = scenes.find(scene.empty() ? DefaultScene() : scene);
        if (found != scenes.end()) {
          view.fragments = found->second.scene->Fragments().Names();
        }
        return view;
      },
      all);
  for (v1::Command& command : all) {
    const CommandTraits* traits = CommandTraits::Find(command.command_case());
    const bool its = traits && traits->GetOwner() == CommandTraits::Owner::Viewport &&
                     traits->OwnerName(command) == viewport;
    if (its && !(command.has_set_text_table() && !table.empty() &&
                 command.set_text_table().name() == table)) {
      Rename(command, as);
      copies.push_back(std::move(command));
    }
  }
  return copies;
}

} // namespace dspace::session
