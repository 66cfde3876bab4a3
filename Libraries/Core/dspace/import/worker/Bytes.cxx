#include <dspace/import/worker/Bytes.h>

#include <cerrno>
#include <system_error>
#include <utility>

#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

namespace dspace {
namespace {

constexpr std::size_t BufferSize = std::size_t(1) << 16;
constexpr std::size_t Alignment = 8;

std::size_t Padding(std::uint64_t position) {
  return static_cast<std::size_t>((Alignment - position % Alignment) % Alignment);
}

} // namespace

void ByteWriter::Text(const std::string& text) {
  this->Number<std::uint64_t>(text.size());
  this->Put(text.data(), text.size());
}

void ByteWriter::Put(const void* data, std::size_t size) {
  const char* bytes = static_cast<const char*>(data);
  this->Position_ += size;
  if (this->Descriptor_ >= 0 && size >= BufferSize) {
    this->Flush();
    this->Write(bytes, size);
    return;
  }
  this->Buffer_.append(bytes, size);
  if (this->Descriptor_ >= 0 && this->Buffer_.size() >= BufferSize) {
    this->Flush();
  }
}

void ByteWriter::Align() {
  const char zeros[Alignment] = {};
  this->Put(zeros, Padding(this->Position_));
}

void ByteWriter::Flush() {
  if (this->Descriptor_ >= 0) {
    this->Write(this->Buffer_.data(), this->Buffer_.size());
    this->Buffer_.clear();
  }
}

void ByteWriter::Write(const char* data, std::size_t size) const {
  while (size > 0) {
    const ssize_t done = ::write(this->Descriptor_, data, size);
    if (done < 0 && errno != EINTR) {
      throw Error(Error::Kind::Io, "the result of an import",
                  "cannot be written: " + std::generic_category().message(errno));
    }
    if (done > 0) {
      data += done;
      size -= static_cast<std::size_t>(done);
    }
  }
}

ByteReader::ByteReader(const void* data, std::size_t size, std::string object)
    : Data_(static_cast<const char*>(data)), Size_(size), Object_(std::move(object)) {}

void ByteReader::Fail(const std::string& what) const {
  throw Error(Error::Kind::Corrupt, this->Object_,
              "the process that reads it gave no valid result: " + what);
}

const char* ByteReader::Take(std::size_t size) {
  if (size > this->Size_ - this->At_) {
    this->Fail("it ends too early");
  }
  const char* at = this->Data_ + this->At_;
  this->At_ += size;
  return at;
}

void ByteReader::Align() {
  this->Take(Padding(this->At_));
}

bool ByteReader::Flag() {
  const auto value = this->Number<std::uint8_t>();
  if (value > 1) {
    this->Fail("a flag is neither 0 nor 1");
  }
  return value == 1;
}

std::size_t ByteReader::Count(std::size_t least) {
  const auto count = this->Number<std::uint64_t>();
  if (count > (this->Size_ - this->At_) / least) {
    this->Fail("it states more than it holds");
  }
  return static_cast<std::size_t>(count);
}

std::string ByteReader::Text() {
  const std::size_t size = this->Count(1);
  return ToUtf8(std::string(this->Take(size), size));
}

void ByteReader::End() const {
  if (this->At_ != this->Size_) {
    this->Fail("it goes on after its end");
  }
}

} // namespace dspace
