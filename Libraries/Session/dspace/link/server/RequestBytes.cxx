#include <dspace/link/server/RequestBytes.h>

#include <utility>

#include <google/protobuf/io/coded_stream.h>
#include <google/protobuf/wire_format_lite.h>

#include <dspace/messages/MessageElements.h>

namespace dspace::session {
namespace {

using google::protobuf::internal::WireFormatLite;
using google::protobuf::io::CodedInputStream;

thread_local std::string Rejection;

// The fields of a SendCommand that are not its command.
bool ReadSend(CodedInputStream& in, v1::SendCommand& send) {
  while (const std::uint32_t tag = in.ReadTag()) {
    const int field = WireFormatLite::GetTagFieldNumber(tag);
    std::uint64_t value = 0;
    if (WireFormatLite::GetTagWireType(tag) != WireFormatLite::WIRETYPE_VARINT) {
      if (!WireFormatLite::SkipField(&in, tag)) {
        return false;
      }
    } else if (!in.ReadVarint64(&value)) {
      return false;
    } else if (field == v1::SendCommand::kNumberFieldNumber) {
      send.set_number(value);
    } else if (field == v1::SendCommand::kNoReplyFieldNumber) {
      send.set_no_reply(value != 0);
    } else if (field == v1::SendCommand::kAcknowledgedFieldNumber) {
      send.set_acknowledged(value);
    }
  }
  return true;
}

// Whether the bytes are a SendCommand, which then is without its command.
bool ReadWithoutCommand(grpc::ByteBuffer* bytes, v1::DriveRequest& request) {
  grpc::ProtoBufferReader reader(bytes);
  CodedInputStream in(&reader);
  std::uint32_t size = 0;
  const std::uint32_t tag = WireFormatLite::MakeTag(v1::DriveRequest::kSendFieldNumber,
                                                    WireFormatLite::WIRETYPE_LENGTH_DELIMITED);
  if (in.ReadTag() != tag || !in.ReadVarint32(&size)) {
    return false;
  }
  const auto limit = in.PushLimit(static_cast<int>(size));
  request.Clear();
  const bool good = ReadSend(in, *request.mutable_send());
  in.PopLimit(limit);
  return good;
}

std::string WhyNot(grpc::ByteBuffer* bytes, const google::protobuf::Message& request) {
  if (!bytes || !bytes->Valid()) {
    return {};
  }
  grpc::ProtoBufferReader reader(bytes);
  return TooManyElements(reader, bytes->Length(), *request.GetDescriptor());
}

template<class Request> grpc::Status Parse(grpc::ByteBuffer* bytes, Request& request) {
  return grpc::GenericDeserialize<grpc::ProtoBufferReader, Request>(bytes, &request);
}

} // namespace

grpc::Status ParseRequest(grpc::ByteBuffer* bytes, v1::DriveRequest& request) {
  Rejection = WhyNot(bytes, request);
  if (Rejection.empty()) {
    return Parse(bytes, request);
  }
  const bool sent = ReadWithoutCommand(bytes, request);
  bytes->Clear();
  return sent ? grpc::Status::OK
              : grpc::Status(grpc::StatusCode::INVALID_ARGUMENT, "the message: " + Rejection);
}

grpc::Status ParseRequest(grpc::ByteBuffer* bytes, google::protobuf::Message& request) {
  const std::string why = WhyNot(bytes, request);
  if (why.empty()) {
    return Parse(bytes, request);
  }
  bytes->Clear();
  return {grpc::StatusCode::INVALID_ARGUMENT, "the message: " + why};
}

std::string TakeRejection() {
  return std::exchange(Rejection, std::string());
}

} // namespace dspace::session
