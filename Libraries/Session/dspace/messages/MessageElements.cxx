#include <dspace/messages/MessageElements.h>

#include <google/protobuf/descriptor.h>
#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/io/zero_copy_stream_impl_lite.h>
#include <google/protobuf/wire_format_lite.h>

#include <dspace/Budgets.h>

namespace dspace::session {
namespace {

using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

constexpr std::size_t LeastBytes = 2; // of an element: its tag, and a length or a number
constexpr int Deepest = 100;          // as protobuf's own parser

class Counter {
public:
  Counter(CodedInputStream& in, std::uint64_t most) : In_(in), Most_(most) {}

  // False: the limit is passed, or the rest cannot be read. `type` is null within unknown groups.
  bool Count(const Descriptor* type, int depth) {
    while (const std::uint32_t tag = this->In_.ReadTag()) {
      if (WireFormatLite::GetTagWireType(tag) == WireFormatLite::WIRETYPE_END_GROUP) {
        return true;
      }
      if (++this->Count_ > this->Most_ || !this->Skip(type, tag, depth)) {
        return false;
      }
    }
    return true;
  }
  std::uint64_t Elements() const { return this->Count_; }

private:
  bool Skip(const Descriptor* type, std::uint32_t tag, int depth) {
    const FieldDescriptor* field =
        type ? type->FindFieldByNumber(WireFormatLite::GetTagFieldNumber(tag)) : nullptr;
    const auto wire = WireFormatLite::GetTagWireType(tag);
    if (wire == WireFormatLite::WIRETYPE_START_GROUP) {
      return depth < Deepest && this->Count(nullptr, depth + 1);
    }
    if (wire != WireFormatLite::WIRETYPE_LENGTH_DELIMITED || !field ||
        field->cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE) {
      return WireFormatLite::SkipField(&this->In_, tag);
    }
    std::uint32_t size = 0;
    if (depth >= Deepest || !this->In_.ReadVarint32(&size)) {
      return false;
    }
    const auto limit = this->In_.PushLimit(static_cast<int>(size));
    const bool good = this->Count(field->message_type(), depth + 1);
    this->In_.PopLimit(limit);
    return good;
  }

  CodedInputStream& In_;
  const std::uint64_t Most_;
  std::uint64_t Count_ = 0;
};

} // namespace

std::uint64_t CountElements(google::protobuf::io::ZeroCopyInputStream& bytes,
                            const Descriptor& type, std::uint64_t most) {
  CodedInputStream in(&bytes);
  Counter counter(in, most);
  counter.Count(&type, 0);
  return counter.Elements();
}

std::string TooManyElements(google::protobuf::io::ZeroCopyInputStream& bytes, std::size_t size,
                            const Descriptor& type) {
  const std::uint64_t most = BudgetOf(Budget::MessageElements);
  if (size / LeastBytes <= most || CountElements(bytes, type, most) <= most) {
    return {};
  }
  return "its " + std::to_string(size) + " bytes have too many elements; " +
         BudgetText(Budget::MessageElements);
}

std::string TooManyElements(const std::string& bytes, const Descriptor& type) {
  google::protobuf::io::ArrayInputStream in(bytes.data(), static_cast<int>(bytes.size()));
  return TooManyElements(in, bytes.size(), type);
}

} // namespace dspace::session
