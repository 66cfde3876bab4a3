// The files of a command, read in a thread of their own, and used by the command.
#include <cstdio>
#include <fstream>

#include <dspace/commands/beforehand/FilesAhead.h>

#include "CommandTestSupport.h"

namespace dspace::testing {
namespace {

using session::FilesAhead;
using session::ReadBeforehand;

constexpr double Long = 60.0; // [s]

class FilesAheadTest : public CommandTest {
protected:
  v1::Command ModelAt(const std::string& name) {
    v1::Command command;
    command.mutable_import_object()->add_level()->set_path(this->Folder_ / name);
    return command;
  }
  std::string Write(const std::string& name) {
    std::ofstream(this->Folder_ / name)
        << "solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
           "endloop\nendfacet\nendsolid a\n";
    return name;
  }

  const TemporaryFolder Folder_;
};

// The command uses the model that was read, and the session then has it.
TEST_F(FilesAheadTest, TheCommandUsesWhatWasRead) {
  const v1::Command command = this->ModelAt(this->Write("a.stl"));
  session::State& state = this->Interpreter_.GetState();
  const auto files = FilesAhead::Begin(state, command);
  ASSERT_TRUE(files);
  ASSERT_TRUE(files->IsRead(Long));
  ASSERT_FALSE(files->Failed().has_error()) << files->Failed().error().message();
  ASSERT_EQ(files->Files()->kept.size(), 1u);
  const ReadBeforehand::Scope scope(files->Files());
  v1::Command read = files->ToExecute(state);
  EXPECT_EQ(read.SerializeAsString(), command.SerializeAsString());
  this->Accept(read);
  // Now the session has the model.
  EXPECT_FALSE(FilesAhead::Begin(state, command));
}

TEST_F(FilesAheadTest, CommandsWithoutFilesHaveNothingToRead) {
  v1::Command command;
  command.mutable_create_frame()->set_name("a");
  EXPECT_FALSE(FilesAhead::Begin(this->Interpreter_.GetState(), command));
}

TEST_F(FilesAheadTest, AFileThatCannotBeReadIsAnError) {
  const auto files = FilesAhead::Begin(this->Interpreter_.GetState(), this->ModelAt("none.stl"));
  ASSERT_TRUE(files);
  ASSERT_TRUE(files->IsRead(Long));
  EXPECT_EQ(files->Failed().error().kind(), v1::Error::NOT_FOUND);
  EXPECT_NE(files->Failed().error().message().find("none.stl"), std::string::npos);
  EXPECT_EQ(files->Files(), nullptr);
}

// The guard holds in the thread.
TEST_F(FilesAheadTest, AGuardRejectsTheFile) {
  const auto files = FilesAhead::Begin(
      this->Interpreter_.GetState(), this->ModelAt(this->Write("b.stl")),
      [](const std::string& path) {
        throw Error(Error::Kind::InvalidArgument, "file '" + path + "'", "is outside");
      });
  ASSERT_TRUE(files);
  ASSERT_TRUE(files->IsRead(Long));
  EXPECT_NE(files->Failed().error().message().find("is outside"), std::string::npos)
      << files->Failed().error().message();
}

} // namespace
} // namespace dspace::testing
