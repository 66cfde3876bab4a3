// Keeps the windows alive while Python computes in their thread.
#ifndef DSPACE_WIDGETS_PYTHON_ATTENDANT_H
#define DSPACE_WIDGETS_PYTHON_ATTENDANT_H

#include <condition_variable>
#include <functional>
#include <mutex>
#include <thread>

namespace dspace::widgets {

// A thread that watches calls of Python. From a fifth of a second on, it lets the events of Qt in
// between two of Python's instructions, some twenty times a second. A single call of C++ or a sleep
// is not interrupted. One a process, as the interpreter is.
class PythonAttendant {
public:
  // `busy` hears, in Python's thread, that a call takes long (true) and that it has ended (false).
  explicit PythonAttendant(std::function<void(bool)> busy);
  PythonAttendant(const PythonAttendant&) = delete;
  PythonAttendant& operator=(const PythonAttendant&) = delete;
  ~PythonAttendant();

  // Around each call of Python, with the interpreter's lock; calls may be nested.
  void Begin();
  void End();
  bool IsBusy() const { return this->Told_; }

private:
  static int Breathe(void*);
  void Watch();

  std::function<void(bool)> Busy_;
  bool Told_ = false;      // Python's thread
  bool Breathing_ = false; // likewise
  int Depth_ = 0;          // likewise

  std::mutex Mutex_; // of what follows
  std::condition_variable Changed_;
  bool Running_ = false;
  bool Ending_ = false;
  bool Asked_ = false; // a breath is due
  std::thread Thread_;
};

} // namespace dspace::widgets

#endif
