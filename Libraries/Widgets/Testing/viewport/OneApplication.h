// The QApplication of a test program.
#ifndef DSPACE_TEST_ONE_APPLICATION_H
#define DSPACE_TEST_ONE_APPLICATION_H

#include <memory>

#include <QApplication>
#include <gtest/gtest.h>

#include <dspace/widgets/viewport/QtContext.h>

// One for all tests, which ends before the process's static objects do.
class OneApplication : public ::testing::Environment {
public:
  void SetUp() override {
    dspace::widgets::PrepareApplication();
    this->Application_ = std::make_unique<QApplication>(this->Count_, this->Arguments_);
  }
  void TearDown() override { this->Application_.reset(); }

private:
  int Count_ = 1;
  char Name_[5] = "test";
  char* Arguments_[2] = {Name_, nullptr};
  std::unique_ptr<QApplication> Application_;
};

inline const auto* const TheApplication = ::testing::AddGlobalTestEnvironment(new OneApplication);

#endif
