// A disk that is full after a number of bytes.
#ifndef DSPACE_TEST_FULLDISK_H
#define DSPACE_TEST_FULLDISK_H

#include <csignal>

#include <gtest/gtest.h>
#include <sys/resource.h>

namespace dspace::testing {

// While it lives, no file of this process may grow beyond `bytes`.
class FullDisk {
public:
  explicit FullDisk(rlim_t bytes) : Handler_(std::signal(SIGXFSZ, SIG_IGN)) {
    EXPECT_EQ(::getrlimit(RLIMIT_FSIZE, &this->Before_), 0);
    const rlimit small{bytes, this->Before_.rlim_max};
    EXPECT_EQ(::setrlimit(RLIMIT_FSIZE, &small), 0);
  }
  ~FullDisk() {
    ::setrlimit(RLIMIT_FSIZE, &this->Before_);
    std::signal(SIGXFSZ, this->Handler_);
  }
  FullDisk(const FullDisk&) = delete;
  FullDisk& operator=(const FullDisk&) = delete;

private:
  rlimit Before_{};
  void (*Handler_)(int);
};

} // namespace dspace::testing

#endif
