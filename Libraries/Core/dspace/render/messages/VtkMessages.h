// Collects messages that VTK reports while Dspace draws.
#ifndef DSPACE_RENDER_VTK_MESSAGES_H
#define DSPACE_RENDER_VTK_MESSAGES_H

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace dspace {

class VtkErrorTrap;

// Observes VTK's message window, which stays in place: VTK and the user's own window get every
// message as before. Messages of a thread with a VtkErrorTrap also go to that trap; messages of
// other threads are ignored. Its functions may be called from several threads at once.
class VtkMessages {
public:
  static constexpr std::size_t MaximumWarnings = 20; // different ones that are kept

  VtkMessages();
  VtkMessages(const VtkMessages&) = delete;
  VtkMessages& operator=(const VtkMessages&) = delete;
  ~VtkMessages(); // after all its traps

  // Returns the warnings that traps received since the last call, each text once, oldest first.
  std::vector<std::string> TakeWarnings();

private:
  friend class VtkErrorTrap;
  class Observer;
  void Add(VtkErrorTrap& trap);
  void Remove(VtkErrorTrap& trap);
  std::string FirstErrorOf(const VtkErrorTrap& trap) const;
  void Take(bool error, const char* text);

  std::unique_ptr<Observer> Observer_;
  mutable std::mutex Mutex_;                                    // of what follows
  std::map<std::thread::id, std::vector<VtkErrorTrap*>> Traps_; // the innermost last
  std::vector<std::string> Warnings_;
};

} // namespace dspace

#endif
