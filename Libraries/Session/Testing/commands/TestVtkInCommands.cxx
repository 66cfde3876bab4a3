// What VTK reports during a command that does not draw is in its reply.
#include <gtest/gtest.h>

#include <dspace/interpreter/Interpreter.h>

#include "vtkDspaceSession.h"
#include "vtkNew.h"
#include "vtkObject.h"

namespace dspace::testing {
namespace {

class VtkInCommands : public ::testing::Test {
protected:
  // ListScenes with something of VTK's in it.
  v1::Reply List(const std::function<void()>& report) {
    this->Session_->GetInterpreter().Commands().Add(
        v1::Command::kListScenes, &v1::Command::mutable_list_scenes,
        [report](const session::Context&, v1::ListScenes&) { report(); }, session::Needs::Nothing);
    v1::Command command;
    command.mutable_list_scenes();
    v1::Reply reply;
    EXPECT_TRUE(reply.ParseFromString(this->Session_->Execute(command.SerializeAsString())));
    return reply;
  }
  vtkNew<vtkDspaceSession> Session_;
};

TEST_F(VtkInCommands, WarningsAndErrorsAreWarningsOfTheReply) {
  EXPECT_EQ(this->List([] {}).warning_size(), 0);
  const v1::Reply warned = this->List([] {
    vtkGenericWarningMacro(<< "of doubt");
    vtkGenericWarningMacro(<< "of doubt");
  });
  ASSERT_EQ(warned.warning_size(), 2); // they name two lines
  EXPECT_EQ(warned.warning(0).rfind("VTK reported: ", 0), 0u);
  EXPECT_NE(warned.warning(0).find("of doubt"), std::string::npos);
  const v1::Reply failed = this->List([] {
    vtkNew<vtkObject> object;
    vtkErrorWithObjectMacro(object.Get(), << "of failure");
  });
  EXPECT_FALSE(failed.has_error());
  ASSERT_EQ(failed.warning_size(), 1);
  EXPECT_EQ(failed.warning(0).rfind("the command was executed, but VTK reported an error: ", 0),
            0u);
  EXPECT_NE(failed.warning(0).find("of failure"), std::string::npos);
  vtkGenericWarningMacro(<< "of the user's own code");
  EXPECT_EQ(this->List([] {}).warning_size(), 0);
}

} // namespace
} // namespace dspace::testing
