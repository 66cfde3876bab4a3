// Plain binary records between the processes of an import: internal, not installed.
#ifndef DSPACE_IMPORT_WORKER_BYTES_H
#define DSPACE_IMPORT_WORKER_BYTES_H

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <string>
#include <type_traits>
#include <vector>

namespace dspace {

// Numbers as this machine has them; arrays begin at multiples of 8 bytes.
class ByteWriter {
public:
  // Into Text().
  ByteWriter() = default;
  // Into a file, through a buffer: call Flush() at the end.
  explicit ByteWriter(int descriptor) : Descriptor_(descriptor) {}

  template<typename T> void Number(T value) {
    static_assert(std::is_arithmetic_v<T>);
    this->Put(&value, sizeof value);
  }
  void Text(const std::string& text);
  template<typename T> void Array(const std::vector<T>& values) {
    static_assert(std::is_arithmetic_v<T>);
    this->Number<std::uint64_t>(values.size());
    this->Align();
    this->Put(values.data(), values.size() * sizeof(T));
  }
  // Throws Error(Io) where the file takes no more.
  void Flush();
  const std::string& Text() const { return this->Buffer_; }

private:
  void Put(const void* data, std::size_t size);
  void Align();
  void Write(const char* data, std::size_t size) const;

  int Descriptor_ = -1;
  std::string Buffer_;
  std::uint64_t Position_ = 0;
};

// Reads what a ByteWriter wrote, or anything else: nothing beyond the end is touched, and no more
// is allocated than the bytes that are there justify. Throws Error(Corrupt) that names `object`.
class ByteReader {
public:
  // `data` is aligned to 8 bytes and outlives the reader.
  ByteReader(const void* data, std::size_t size, std::string object);

  template<typename T> T Number() {
    static_assert(std::is_arithmetic_v<T>);
    T value;
    std::memcpy(&value, this->Take(sizeof value), sizeof value);
    return value;
  }
  // A bool, of one byte that is 0 or 1.
  bool Flag();
  // An enumerator, of one byte, up to `last`.
  template<typename E> E Enumerator(E last) {
    const auto value = this->Number<std::uint8_t>();
    if (value > static_cast<std::uint8_t>(last)) {
      this->Fail("a value of an enumeration is out of range");
    }
    return static_cast<E>(value);
  }
  std::string Text(); // UTF-8, whatever was written
  template<typename T> std::vector<T> Array() {
    const std::size_t count = this->Count(sizeof(T));
    this->Align();
    const auto* begin = reinterpret_cast<const T*>(this->Take(count * sizeof(T)));
    return std::vector<T>(begin, begin + count);
  }
  // The number of records that follow, of at least `least` bytes each.
  std::size_t Count(std::size_t least);
  // Throws unless all was read.
  void End() const;
  [[noreturn]] void Fail(const std::string& what) const;

private:
  const char* Take(std::size_t size);
  void Align();

  const char* Data_;
  std::size_t Size_;
  std::size_t At_ = 0;
  std::string Object_;
};

} // namespace dspace

#endif
