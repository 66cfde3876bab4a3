// Results of requests that are computed in threads of their own.
#include <dspace/interpreter/Registry.h>
#include <dspace/state/Works.h>

namespace dspace::session {

void AddWorkRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(
      C::kAwaitWork, &C::mutable_await_work,
      [](const Context& context, const v1::AwaitWork& command) {
        context.state.works->Await(context.reply, command);
      },
      Needs::Nothing);
}

} // namespace dspace::session
