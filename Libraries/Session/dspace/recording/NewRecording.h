// The place of a recording that is being made from another one. Not a public header.
#ifndef DSPACE_RECORDING_NEW_RECORDING_H
#define DSPACE_RECORDING_NEW_RECORDING_H

#include <memory>
#include <string>

#include <dspace/AtomicFile.h>

namespace dspace::session {

// A file that appears as a whole or not at all: it is written under another name until it is kept.
class NewRecording {
public:
  // Throws Error: AlreadyExists (there is such a file), NotFound (there is no such folder), Io.
  explicit NewRecording(const std::string& path);
  ~NewRecording();
  NewRecording(const NewRecording&) = delete;
  NewRecording& operator=(const NewRecording&) = delete;

  // Where it is written: an empty file, beside the target.
  const std::string& Path() const;
  // What it is called in messages.
  const std::string& Name() const { return this->Name_; }
  // Gives the file its own name, once it is whole and closed. Throws as the constructor.
  void Keep();

private:
  void RequireNone() const;

  const std::string Target_; // absolute
  const std::string Name_;
  std::unique_ptr<AtomicFile> File_;
};

} // namespace dspace::session

#endif
