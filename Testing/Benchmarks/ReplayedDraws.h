// Bare OpenGL with which a drawing of ours is compared: the same program, buffers and textures,
// drawn again with nothing around them.
#ifndef DSPACE_BENCH_REPLAYED_DRAWS_H
#define DSPACE_BENCH_REPLAYED_DRAWS_H

#include <string>
#include <vector>

#include "vtk_glew.h"

namespace dspace::bench {

// What glMultiDrawElements was called with, and the state that it found.
class ReplayedDraws {
public:
  // Every call from now on, until End().
  void Begin();
  void End();
  // Into the framebuffer that they went to, cleared to `clear`; depth reversed, as recorded.
  void Replay(const float clear[4]) const;
  std::size_t Count() const { return this->Draws_.size(); }
  std::size_t Triangles() const;

private:
  struct Uniform {
    GLint location = 0;
    GLenum type = 0;
    GLint size = 1;
    std::vector<GLfloat> floats;
    std::vector<GLint> integers;
  };
  struct Draw {
    GLenum mode = 0;
    std::vector<GLsizei> counts;
    GLenum type = 0;
    std::vector<const void*> firsts;
    std::vector<Uniform> uniforms; // those that differ from the draw before
  };
  static void GLAPIENTRY Hook(GLenum mode, const GLsizei* counts, GLenum type,
                              const void* const* firsts, GLsizei draws);
  static void Set(const Uniform& uniform);
  static std::vector<Uniform> UniformsOf(GLint program);

  std::vector<Draw> Draws_;
  GLint Program_ = 0;
  GLint VertexArray_ = 0;
  GLint Framebuffer_ = 0;
  GLint Viewport_[4] = {};
  bool Culled_ = false;
  GLint CulledFace_ = GL_BACK;
  bool Srgb_ = false;
  struct Texture {
    GLint unit;
    GLenum target;
    GLint name;
  };
  std::vector<Texture> Textures_;
  std::vector<Uniform> Before_;
};

} // namespace dspace::bench

#endif
