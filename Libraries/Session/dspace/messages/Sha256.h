// SHA-256 of bytes.
#ifndef DSPACE_SESSION_SHA256_H
#define DSPACE_SESSION_SHA256_H

#include <cstddef>
#include <string>

namespace dspace::session {

class Sha256 {
public:
  Sha256();
  ~Sha256();
  Sha256(const Sha256&) = delete;
  Sha256& operator=(const Sha256&) = delete;
  void Add(const void* data, std::size_t size);
  std::string Finish(); // 32 bytes; ready for the next one

private:
  void* Context_;
};

} // namespace dspace::session

#endif
