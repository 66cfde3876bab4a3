// A render window of VTK alone, and a session beside it.
#ifndef DSPACE_PLAIN_WINDOW_H
#define DSPACE_PLAIN_WINDOW_H

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include <google/protobuf/text_format.h>
#include <gtest/gtest.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkGenericOpenGLRenderWindow.h"
#include "vtkNew.h"
#include "vtkObjectFactory.h"
#include "vtkRenderer.h"
#include "vtkUnsignedCharArray.h"

#include <dspace/proto/commands.pb.h>
#include <dspace/render/EglContext.h>
#include <dspace/render/GraphicsContext.h>

namespace dspace::testing {

// Draws with VTK's own mappers and shaders into an OpenGL context of its own, without a display.
class PlainWindow : public vtkGenericOpenGLRenderWindow {
public:
  static PlainWindow* New() { VTK_STANDARD_NEW_BODY(PlainWindow); }
  vtkTypeMacro(PlainWindow, vtkGenericOpenGLRenderWindow);

  void MakeCurrent() override { this->Context_->MakeCurrent(); }
  bool IsCurrent() override { return this->Context_->IsCurrent(); }

protected:
  PlainWindow() {
    this->SetOwnContext(1);
    this->SetFrameBlitModeToNoBlit();
    this->SwapBuffers = 0;
    this->MultiSamples = 0;
    this->Context_->MakeCurrent();
    this->OpenGLInit();
  }
  ~PlainWindow() override { this->Finalize(); }
  // The OpenGL functions are loaded: a Dspace context was there before.
  void OpenGLInitContext() override {
    this->GlewInitValid = true;
    this->Initialized = true;
  }
  int GetColorBufferSizes(int* rgba) override {
    std::fill_n(rgba, 4, 8); // the context has no buffers of its own
    return 32;
  }

private:
  std::unique_ptr<GraphicsContext> Context_ = MakeEglContext();
};

// A picture: row 0 on top.
struct Picture {
  int width = 0;
  int height = 0;
  std::vector<std::uint8_t> color;  // RGBA
  std::vector<std::uint32_t> label; // of Dspace's pictures
};

class PlainWindowTest : public ::testing::Test {
protected:
  static constexpr int Width = 240;
  static constexpr int Height = 180;

  void SetUp() override {
    this->Session_->GetRenderContext()->GetRendererName(); // loads OpenGL
    this->Window_ = vtkSmartPointer<PlainWindow>::New();
    this->Window_->SetSize(Width, Height);
    this->Window_->AddRenderer(this->Renderer_);
    this->Renderer_->SetBackground(0, 0, 0);
  }

  v1::Reply Execute(v1::Command command) {
    v1::Reply reply;
    EXPECT_TRUE(reply.ParseFromString(this->Session_->Execute(command.SerializeAsString())));
    return reply;
  }

  v1::Reply Run(const std::string& text) {
    v1::Command command;
    EXPECT_TRUE(google::protobuf::TextFormat::ParseFromString(text, &command)) << text;
    const v1::Reply reply = this->Execute(command);
    EXPECT_FALSE(reply.has_error()) << text << reply.error().message();
    return reply;
  }

  // A viewport of the same size, one sample a pixel.
  void MakeView() {
    this->Run("create_viewport { name: 'view' width: 240 height: 180 samples: 1 }");
  }

  Picture Ours() {
    const v1::CaptureReply capture =
        this->Run("capture { viewport: 'view' color: true label: true inline_data: true }")
            .capture();
    Picture picture;
    picture.width = int(capture.width());
    picture.height = int(capture.height());
    for (const v1::Plane& plane : capture.plane()) {
      if (plane.name() == "color") {
        picture.color.assign(plane.data().begin(), plane.data().end());
      } else {
        picture.label.resize(plane.data().size() / 4);
        std::copy(plane.data().begin(), plane.data().end(),
                  reinterpret_cast<char*>(picture.label.data()));
      }
    }
    return picture;
  }

  Picture Plain() {
    this->Window_->MakeCurrent();
    this->Window_->Render();
    vtkNew<vtkUnsignedCharArray> pixels;
    this->Window_->GetRGBACharPixelData(0, 0, Width - 1, Height - 1, 0, pixels);
    Picture picture;
    picture.width = Width;
    picture.height = Height;
    for (int y = Height - 1; y >= 0; --y) {
      const unsigned char* row = pixels->GetPointer(4 * Width * y);
      picture.color.insert(picture.color.end(), row, row + 4 * Width);
    }
    return picture;
  }

  // Compares the colours where a pixel and its neighbours show the same object. Returns the number
  // of pixels compared, objects' alone.
  static int Compare(const Picture& ours, const Picture& plain, int tolerance) {
    int compared = 0;
    int wrong = 0;
    for (int y = 1; y + 1 < ours.height; ++y) {
      for (int x = 1; x + 1 < ours.width; ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(ours.width) + std::size_t(x);
        bool inside = true;
        for (int dy = -1; dy <= 1; ++dy) {
          for (int dx = -1; dx <= 1; ++dx) {
            inside &= ours.label[i + std::size_t(dy * ours.width + dx)] == ours.label[i];
          }
        }
        if (!inside) {
          continue;
        }
        compared += ours.label[i] != 0;
        for (std::size_t k = 0; k < 3; ++k) {
          const int difference = int(ours.color[4 * i + k]) - int(plain.color[4 * i + k]);
          if (std::abs(difference) > tolerance && ++wrong <= 5) {
            ADD_FAILURE() << "pixel " << x << ", " << y << " channel " << k << ": ours "
                          << int(ours.color[4 * i + k]) << ", VTK's " << int(plain.color[4 * i + k])
                          << ", object " << ours.label[i];
          }
        }
      }
    }
    EXPECT_EQ(wrong, 0);
    return compared;
  }

  vtkNew<vtkDspaceSession> Session_;
  vtkNew<vtkRenderer> Renderer_;
  vtkSmartPointer<PlainWindow> Window_;
};

} // namespace dspace::testing

#endif
