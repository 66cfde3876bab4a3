// Errors that OpenGL reports fail a test: what Dspace draws throws, and after any other call the
// process ends with status 1. Each error is made in a process of its own.
#include "RenderingTestSupport.h"

#include <cstdlib>

#include "vtkRenderWindow.h"
#include "vtk_glew.h"

#include <dspace/render/EglContext.h>

namespace dspace {
namespace {

constexpr unsigned NoCapability = 0xffff;

struct DebugOutputTest : ::testing::Test {
  void SetUp() override {
    GTEST_FLAG_SET(death_test_style, "threadsafe"); // a fork would share the driver's state
    setenv("DSPACE_OPENGL_DEBUG", "1", 1);
  }
  void TearDown() override {
    if (this->Before_.empty()) {
      unsetenv("DSPACE_OPENGL_DEBUG");
    } else {
      setenv("DSPACE_OPENGL_DEBUG", this->Before_.c_str(), 1);
    }
  }
  const std::string Before_ =
      std::getenv("DSPACE_OPENGL_DEBUG") ? std::getenv("DSPACE_OPENGL_DEBUG") : "";
};

// In a viewport: what it throws; empty: nothing.
std::string ErrorOfDrawing(void (*draw)(vtkRenderWindow*)) {
  vtkNew<vtkDspaceRenderContext> context;
  const auto scene = std::make_shared<Scene>("scene");
  scene->CreateVantage("main");
  Camera camera;
  camera.name = "camera";
  scene->SetCamera("main", camera);
  vtkNew<vtkDspaceViewport> viewport;
  viewport->Initialize(context, scene, "view", "main", 20, 20);
  try {
    viewport->Run(draw);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

// Ends the process as a test does that has passed.
[[noreturn]] void End(bool good) {
  std::exit(good ? 0 : 3);
}

} // namespace

TEST_F(DebugOutputTest, ADrawingErrorIsThrownAndFailsTheProcess) {
  EXPECT_EXIT(
      {
        const std::string error = ErrorOfDrawing([](vtkRenderWindow*) { glEnable(NoCapability); });
        const bool good = error.find("OpenGL reported an error: ") != std::string::npos &&
                          error.find("GL_INVALID_ENUM") != std::string::npos;
        std::fprintf(stderr, "thrown: %s\n", error.c_str());
        End(good);
      },
      ::testing::ExitedWithCode(1), "thrown: .*GL_INVALID_ENUM(.|\n)*1 messages of OpenGL");
}

TEST_F(DebugOutputTest, AnErrorOutsideOfDrawingFailsTheProcess) {
  EXPECT_EXIT(
      {
        vtkNew<vtkDspaceRenderContext> context;
        context->GetRendererName();
        context->GetRenderWindow()->MakeCurrent();
        glEnable(NoCapability);
        glGetError(); // reading it hides nothing
        End(true);
      },
      ::testing::ExitedWithCode(1), "OpenGL reported an error: .*GL_INVALID_ENUM(.|\n)*1 messages");
}

TEST_F(DebugOutputTest, GoodDrawingPasses) {
  EXPECT_EXIT(End(ErrorOfDrawing([](vtkRenderWindow*) { glEnable(GL_BLEND); }).empty()),
              ::testing::ExitedWithCode(0), "");
}

TEST_F(DebugOutputTest, OffWhereItIsNotAskedFor) {
  setenv("DSPACE_OPENGL_DEBUG", "0", 1);
  EXPECT_EXIT(
      {
        vtkNew<vtkDspaceRenderContext> context;
        context->GetRendererName();
        context->GetRenderWindow()->MakeCurrent();
        int flags = 0;
        glGetIntegerv(GL_CONTEXT_FLAGS, &flags);
        glEnable(NoCapability);
        End((flags & GL_CONTEXT_FLAG_DEBUG_BIT) == 0 && glGetError() == GL_INVALID_ENUM);
      },
      ::testing::ExitedWithCode(0), "");
}

TEST_F(DebugOutputTest, AnotherValueIsRejected) {
  setenv("DSPACE_OPENGL_DEBUG", "yes", 1);
  try {
    MakeEglContext();
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("DSPACE_OPENGL_DEBUG"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("'yes'; accepted are '0' and '1'"), std::string::npos);
  }
}

} // namespace dspace
