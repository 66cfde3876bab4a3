// VTK's messages while Dspace draws: errors become exceptions, warnings are kept for the user.
#include "RenderingTestSupport.h"

#include <thread>

#include <dspace/Error.h>
#include <dspace/render/messages/VtkErrorTrap.h>
#include <dspace/render/messages/VtkMessages.h>

#include "vtkObject.h"
#include "vtkStringOutputWindow.h"

namespace dspace {
namespace {

void Warn(const char* text) {
  vtkGenericWarningMacro(<< text);
}

void Fail(const char* text) {
  vtkNew<vtkObject> object;
  vtkErrorWithObjectMacro(object.Get(), << text);
}

// VTK's window as it was, whatever a test does.
struct VtkMessagesTest : ::testing::Test {
  vtkSmartPointer<vtkOutputWindow> before = vtkOutputWindow::GetInstance();
  VtkMessages messages;
  void TearDown() override { vtkOutputWindow::SetInstance(before); }
};

bool Throws(const VtkErrorTrap& trap, const std::string& text) {
  try {
    trap.Check("picture");
  } catch (const Error& error) {
    return std::string(error.what()).find(text) != std::string::npos;
  }
  return false;
}

} // namespace

TEST_F(VtkMessagesTest, ErrorsBecomeExceptionsAndWarningsAreKeptOnce) {
  Warn("before the trap");
  {
    const VtkErrorTrap trap(messages);
    EXPECT_NO_THROW(trap.Check("picture"));
    Warn("first");
    Warn("second");
    Warn("second");
    EXPECT_NO_THROW(trap.Check("picture"));
    Fail("one error");
    Fail("another error");
    EXPECT_TRUE(Throws(trap, "one error"));
    EXPECT_FALSE(Throws(trap, "another error"));
  }
  const std::vector<std::string> warnings = messages.TakeWarnings();
  ASSERT_EQ(warnings.size(), 2u);
  EXPECT_NE(warnings[0].find("first"), std::string::npos);
  EXPECT_NE(warnings[1].find("second"), std::string::npos);
  EXPECT_TRUE(messages.TakeWarnings().empty());
}

TEST_F(VtkMessagesTest, TheInnermostTrapTakesAnError) {
  const VtkErrorTrap outer(messages);
  {
    const VtkErrorTrap inner(messages);
    Fail("within");
    EXPECT_TRUE(Throws(inner, "within"));
  }
  EXPECT_NO_THROW(outer.Check("picture"));
  Fail("after it");
  EXPECT_TRUE(Throws(outer, "after it"));
}

TEST_F(VtkMessagesTest, MessagesOfOtherThreadsAreLeftAlone) {
  const VtkErrorTrap trap(messages);
  std::thread other([] {
    Warn("elsewhere");
    Fail("elsewhere");
  });
  other.join();
  EXPECT_NO_THROW(trap.Check("picture"));
  EXPECT_TRUE(messages.TakeWarnings().empty());
}

TEST_F(VtkMessagesTest, AWindowOfTheUsersGetsEveryMessage) {
  { const VtkErrorTrap trap(messages); } // observes the window before
  vtkNew<vtkStringOutputWindow> window;
  vtkOutputWindow::SetInstance(window);
  const VtkErrorTrap trap(messages);
  Warn("a warning");
  Fail("an error");
  EXPECT_EQ(vtkOutputWindow::GetInstance(), window.Get());
  EXPECT_NE(window->GetOutput().find("a warning"), std::string::npos);
  EXPECT_NE(window->GetOutput().find("an error"), std::string::npos);
  EXPECT_TRUE(Throws(trap, "an error"));
  EXPECT_EQ(messages.TakeWarnings().size(), 1u);
}

TEST_F(RenderingFixture, AnErrorOfVtkWhileDrawingIsThrown) {
  Look(Projection());
  auto viewport = View(20, 20);
  EXPECT_THROW(viewport->Run([](vtkRenderWindow*) { Fail("drawn badly"); }), Error);
  EXPECT_NO_THROW(viewport->Run([](vtkRenderWindow*) { Warn("drawn oddly"); }));
  const std::vector<std::string> warnings = context->GetMessages().TakeWarnings();
  ASSERT_EQ(warnings.size(), 1u);
  EXPECT_NE(warnings[0].find("drawn oddly"), std::string::npos);
}

} // namespace dspace
