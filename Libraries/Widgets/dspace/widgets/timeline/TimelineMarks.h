// The user's marks of a recording, and the side file that keeps them.
#ifndef DSPACE_WIDGETS_TIMELINE_MARKS_H
#define DSPACE_WIDGETS_TIMELINE_MARKS_H

#include <string>
#include <vector>

namespace dspace::widgets {

// A place on the timeline with a note.
struct TimelineMark {
  std::string id;      // unique in its file, not empty
  double time_s = 0.0; // simulation time
  std::string note;    // may hold line breaks
};

// The side file of a recording: "PATH.marks.json".
std::string MarksPath(const std::string& recording);
// A new mark's id.
std::string NewMarkId();

// Marks are sorted by time. Every change reads the file, changes one mark, and writes the file as a
// whole (AtomicFile.h), so that marks of other processes and fields of other programs stay. Each
// returns the marks of the file afterwards. No file is a file without marks. Throws Error and
// leaves the file as it is: Corrupt for a file that is not of this kind, Unsupported for one of a
// newer version, Io for what the system reports, InvalidArgument for a mark without an id or a time
// that is not finite.
std::vector<TimelineMark> LoadMarks(const std::string& path);
std::vector<TimelineMark> PutMark(const std::string& path, const TimelineMark& mark);
std::vector<TimelineMark> EraseMark(const std::string& path, const std::string& id);

} // namespace dspace::widgets

#endif
