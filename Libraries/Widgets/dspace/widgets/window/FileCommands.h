// Commands that read files, without holding the windows.
#ifndef DSPACE_WIDGETS_FILE_COMMANDS_H
#define DSPACE_WIDGETS_FILE_COMMANDS_H

#include <map>
#include <memory>
#include <string>

#include <QObject>

class vtkDspaceSession;

namespace dspace::widgets {

class TaskStrip;

// Reads the files of a command of a session in a thread of its own; meanwhile the windows live, and
// the strip shows what is read, with a button that cancels it. What is cancelled, or hangs, is left
// to its thread, and nothing of the session changes.
class FileCommands : public QObject {
  Q_OBJECT

public:
  // Both must outlive it.
  FileCommands(vtkDspaceSession* session, TaskStrip* strip, QObject* parent = nullptr);
  ~FileCommands() override;

  // Reads the files of a serialized command, in the session's thread, and returns when they are
  // read; events are handled meanwhile, from a fiftieth of a second on. Nothing happens for
  // commands without files. Throws Error(Resource) if it is cancelled.
  void Read(const std::string& command);
  // Executes a serialized Command with the files that Read() has read, and returns the serialized
  // Reply: the error, where they could not be read.
  std::string Execute(const std::string& command);
  // Ends all that is being read.
  void CancelAll();
  // Whether something is read at present.
  bool IsReading() const { return !this->Jobs_.empty(); }

private:
  struct Job;
  vtkDspaceSession* Session_;
  TaskStrip* Strip_;
  std::map<long, std::shared_ptr<Job>> Jobs_;         // that are being read, by their task
  std::map<std::string, std::shared_ptr<Job>> Ready_; // by their command
  long Last_ = 0;
};

} // namespace dspace::widgets

#endif
