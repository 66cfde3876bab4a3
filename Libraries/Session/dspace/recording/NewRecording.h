// The file of a recording that is created from another one. Not a public header.
#ifndef DSPACE_RECORDING_NEW_RECORDING_H
#define DSPACE_RECORDING_NEW_RECORDING_H

#include <memory>
#include <string>

#include <dspace/AtomicFile.h>

namespace dspace::session {

// A file that appears complete or not at all: it has a temporary name until Keep().
class NewRecording {
public:
  // Throws Error: AlreadyExists (there is such a file), NotFound (there is no such folder), Io.
  explicit NewRecording(const std::string& path);
  ~NewRecording();
  NewRecording(const NewRecording&) = delete;
  NewRecording& operator=(const NewRecording&) = delete;

  // The temporary path, beside the target: an empty file at first.
  const std::string& Path() const;
  // Its name in messages.
  const std::string& Name() const { return this->Name_; }
  // Gives the complete and closed file its final name. Throws as the constructor does.
  void Keep();

private:
  void RequireNone() const;

  const std::string Target_; // absolute
  const std::string Name_;
  std::unique_ptr<AtomicFile> File_;
};

} // namespace dspace::session

#endif
