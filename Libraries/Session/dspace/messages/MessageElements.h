// How many parts a serialized message has, counted before it is parsed.
#ifndef DSPACE_SESSION_MESSAGE_ELEMENTS_H
#define DSPACE_SESSION_MESSAGE_ELEMENTS_H

#include <cstddef>
#include <cstdint>
#include <string>

namespace google::protobuf {
class Descriptor;
namespace io {
class ZeroCopyInputStream;
}
} // namespace google::protobuf

namespace dspace::session {

// An empty message has two bytes where it is sent and some hundred in memory, so that the size of a
// message says little of what it costs. An element is one field that is present, one item of a
// repeated field or one message, at any depth; packed numbers count as one field.
//
// Counts up to `most` + 1. Bytes that are no message are counted as far as they can be read.
std::uint64_t CountElements(google::protobuf::io::ZeroCopyInputStream& bytes,
                            const google::protobuf::Descriptor& type, std::uint64_t most);

// Empty, or why a message of that many bytes may not be parsed: it has more elements than
// Budget::MessageElements (Budgets.h). Messages that are too short for so many are not read.
std::string TooManyElements(const std::string& bytes, const google::protobuf::Descriptor& type);
std::string TooManyElements(google::protobuf::io::ZeroCopyInputStream& bytes, std::size_t size,
                            const google::protobuf::Descriptor& type);

} // namespace dspace::session

#endif
