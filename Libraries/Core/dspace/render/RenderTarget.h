// Framebuffers of a viewport: colour and float depth as textures.
#ifndef DSPACE_RENDER_RENDER_TARGET_H
#define DSPACE_RENDER_RENDER_TARGET_H

#include <cstdint>
#include <vector>

#include "vtkNew.h"

class vtkDspaceHubWindow;
class vtkOpenGLFramebufferObject;
class vtkTextureObject;

namespace dspace {

// A colour texture with 32-bit float depth. The formats: Display is sRGB bytes (decoded when
// read, encoded when written under GL_FRAMEBUFFER_SRGB); Linear is half floats for blending;
// Light is 32-bit floats of linear light; Label is one 32-bit unsigned integer; Number is one
// 32-bit float.
class RenderTarget {
public:
  enum class Format { Display, Linear, Light, Label, Number };
  // Depth: the format of the depth texture. Window is what VTK's volume mapper copies with a blit,
  // which OpenGL allows between equal formats only.
  enum class DepthFormat { None, Float, Window };
  RenderTarget(vtkDspaceHubWindow* window, Format format, DepthFormat depth);
  RenderTarget(const RenderTarget&) = delete;
  RenderTarget& operator=(const RenderTarget&) = delete;
  ~RenderTarget();

  // Throws Error(Resource) when OpenGL cannot make it; contents are undefined after a change.
  void Resize(int width, int height);
  Format GetFormat() const { return this->Format_; }
  int Width() const { return this->Width_; }
  int Height() const { return this->Height_; }

  vtkOpenGLFramebufferObject* Framebuffer() const;
  // Makes it the framebuffer that is drawn into, its whole area the OpenGL viewport.
  void Bind();
  unsigned int Color() const; // OpenGL names of the textures
  unsigned int Depth() const;

  // Rows from the top down.
  std::vector<std::uint8_t> ReadColor() const;                            // RGBA; Display
  std::vector<float> ReadLight() const;                                   // RGBA; Light
  std::vector<std::uint32_t> ReadLabel(int x, int y, int w, int h) const; // Label
  std::vector<float> ReadDepth(int x, int y, int w, int h) const;         // buffer values

  void Release();

private:
  template<class T>
  std::vector<T> Read(int x, int y, int w, int h, unsigned int format, unsigned int type,
                      int channels) const;
  vtkDspaceHubWindow* Window_;
  Format Format_;
  DepthFormat DepthFormat_;
  int Width_ = 0;
  int Height_ = 0;
  vtkNew<vtkOpenGLFramebufferObject> Framebuffer_;
  vtkNew<vtkTextureObject> Color_;
  vtkNew<vtkTextureObject> Depth_;
};

} // namespace dspace

#endif
