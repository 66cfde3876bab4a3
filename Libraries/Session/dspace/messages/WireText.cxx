#include <dspace/messages/WireText.h>

#include <algorithm>
#include <cstdint>
#include <string_view>

#include <google/protobuf/descriptor.h>

#include <dspace/Utf8.h>

namespace dspace::session {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;

constexpr int DeepestText = 100; // nested messages, as protobuf's parser accepts

// The wire format: developers.google.com/protocol-buffers/docs/encoding.
enum WireType { Varint = 0, Fixed64 = 1, Bytes = 2, Fixed32 = 5 };

// Moves `at` on; false where the bytes end before it.
bool ReadVarint(std::string_view in, std::size_t& at, std::uint64_t& value) {
  value = 0;
  for (unsigned shift = 0; shift < 64 && at < in.size(); shift += 7) {
    const auto byte = static_cast<unsigned char>(in[at++]);
    value |= std::uint64_t(byte & 127u) << shift;
    if (byte < 128) {
      return true;
    }
  }
  return false;
}

void PutVarint(std::uint64_t value, std::string& out) {
  for (; value > 127; value >>= 7) {
    out += char((value & 127) | 128);
  }
  out += char(value);
}

bool IsForeign(std::string_view text) {
  const bool ascii =
      std::none_of(text.begin(), text.end(), [](char c) { return (c & '\x80') != 0; });
  return !ascii && !IsUtf8(std::string(text));
}

// Walks a message, and copies it if `out` is not null.
class Walk {
public:
  bool Message(std::string_view in, const Descriptor* type, std::string* out, int depth = 0) {
    if (depth > DeepestText) {
      return false;
    }
    for (std::size_t at = 0; at < in.size();) {
      const std::size_t begin = at;
      std::uint64_t tag = 0, number = 0;
      if (!ReadVarint(in, at, tag)) {
        return false;
      }
      if ((tag & 7) == Bytes) {
        const std::size_t length = at;
        if (!ReadVarint(in, at, number) || number > in.size() - at) {
          return false;
        }
        const std::string_view content = in.substr(at, std::size_t(number));
        at += content.size();
        const FieldDescriptor* field = tag >> 3 <= FieldDescriptor::kMaxNumber
                                           ? type->FindFieldByNumber(int(tag >> 3))
                                           : nullptr;
        if (!this->Field(in.substr(begin, length - begin), content, field, out, depth)) {
          return false;
        }
        continue;
      }
      const std::size_t size = (tag & 7) == Fixed64 ? 8 : (tag & 7) == Fixed32 ? 4 : 0;
      if (size == 0 && ((tag & 7) != Varint || !ReadVarint(in, at, number))) {
        return false; // groups, which no message of ours has
      }
      if (size > in.size() - at) {
        return false;
      }
      at += size;
      if (out) {
        out->append(in.substr(begin, at - begin));
      }
    }
    return true;
  }

  bool foreign = false; // there was text of another encoding

private:
  bool Field(std::string_view tag, std::string_view content, const FieldDescriptor* field,
             std::string* out, int depth) {
    std::string changed;
    const bool below = field && field->type() == FieldDescriptor::TYPE_MESSAGE;
    const bool text = field && field->type() == FieldDescriptor::TYPE_STRING && IsForeign(content);
    this->foreign = this->foreign || text;
    if (below &&
        !this->Message(content, field->message_type(), out ? &changed : nullptr, depth + 1)) {
      return false;
    }
    if (!out) {
      return true;
    }
    if (text) {
      changed = ToUtf8(std::string(content));
    }
    const std::string_view now = below || text ? std::string_view(changed) : content;
    out->append(tag);
    PutVarint(now.size(), *out);
    out->append(now);
    return true;
  }
};

} // namespace

std::optional<std::string> WithTextUtf8(const std::string& message, const Descriptor& type) {
  Walk looked;
  if (!looked.Message(message, &type, nullptr) || !looked.foreign) {
    return std::nullopt;
  }
  std::string out;
  out.reserve(message.size() + message.size() / 8);
  Walk().Message(message, &type, &out);
  return out;
}

std::optional<std::string> WithTextUtf8OfAll(const std::string& messages, const Descriptor& type) {
  std::string out;
  bool foreign = false;
  for (std::size_t at = 0; at < messages.size();) {
    std::uint64_t size = 0;
    if (!ReadVarint(messages, at, size) || size > messages.size() - at) {
      return std::nullopt;
    }
    std::string one = messages.substr(at, std::size_t(size));
    at += one.size();
    if (std::optional<std::string> changed = WithTextUtf8(one, type)) {
      one = std::move(*changed);
      foreign = true;
    }
    PutVarint(one.size(), out);
    out += one;
  }
  return foreign ? std::optional<std::string>(std::move(out)) : std::nullopt;
}

} // namespace dspace::session
