// What the readers and writers of camera models share: internal, not installed.
#ifndef DSPACE_CAMERA_FILES_MODEL_TEXT_H
#define DSPACE_CAMERA_FILES_MODEL_TEXT_H

#include <cstddef>
#include <string>
#include <vector>

namespace dspace {

// The first `most` bytes of a file, which is noted as read (FilesRead.h). Throws Error(NotFound,
// Io), Error(Corrupt) for an empty file.
std::string ReadModelText(const std::string& path, std::size_t most = 1 << 22);

// A number that reads back as the same double.
std::string ExactText(double value);
// Several, separated by `between`.
std::string ExactTexts(const std::vector<double>& values, const char* between);

// All numbers of a text: separated by blanks, commas or brackets. Throws Error(Corrupt) naming
// `label` and the word that is no finite number.
std::vector<double> NumbersIn(const std::string& text, const std::string& label);
// One finite number.
double NumberIn(const std::string& word, const std::string& label);
// A side of an image in pixels, which `what` names: an integer from 1 to 1e6. Throws
// Error(InvalidArgument).
int ImageSide(double side, const char* what, const std::string& label);

std::string TrimmedText(const std::string& text);
std::string UpperText(std::string text);

} // namespace dspace

#endif
