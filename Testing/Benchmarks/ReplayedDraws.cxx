#include "ReplayedDraws.h"

#include <cstring>

namespace dspace::bench {
namespace {

ReplayedDraws* Recorder = nullptr;
PFNGLMULTIDRAWELEMENTSPROC Original = nullptr;

} // namespace

std::vector<ReplayedDraws::Uniform> ReplayedDraws::UniformsOf(GLint program) {
  std::vector<Uniform> uniforms;
  GLint count = 0;
  glGetProgramiv(GLuint(program), GL_ACTIVE_UNIFORMS, &count);
  for (GLint i = 0; i < count; ++i) {
    char name[256];
    Uniform uniform;
    glGetActiveUniform(GLuint(program), GLuint(i), sizeof name, nullptr, &uniform.size,
                       &uniform.type, name);
    const GLint size = uniform.size;
    uniform.size = 1;
    std::string base = name;
    if (size > 1) {
      base = base.substr(0, base.find('['));
    }
    for (GLint k = 0; k < size; ++k) {
      Uniform one = uniform;
      const std::string element = size > 1 ? base + "[" + std::to_string(k) + "]" : base;
      one.location = glGetUniformLocation(GLuint(program), element.c_str());
      if (one.location < 0) {
        continue;
      }
      one.floats.assign(16, 0.0f);
      one.integers.assign(4, 0);
      switch (one.type) {
      case GL_INT:
      case GL_INT_VEC2:
      case GL_SAMPLER_2D:
      case GL_SAMPLER_2D_ARRAY:
      case GL_INT_SAMPLER_2D_ARRAY:
        glGetUniformiv(GLuint(program), one.location, one.integers.data());
        break;
      default:
        glGetUniformfv(GLuint(program), one.location, one.floats.data());
      }
      uniforms.push_back(one);
    }
  }
  return uniforms;
}

void ReplayedDraws::Set(const Uniform& u) {
  const GLfloat* f = u.floats.data();
  const GLint* i = u.integers.data();
  switch (u.type) {
  case GL_FLOAT:
    glUniform1fv(u.location, 1, f);
    break;
  case GL_FLOAT_VEC2:
    glUniform2fv(u.location, 1, f);
    break;
  case GL_FLOAT_VEC3:
    glUniform3fv(u.location, 1, f);
    break;
  case GL_FLOAT_VEC4:
    glUniform4fv(u.location, 1, f);
    break;
  case GL_FLOAT_MAT2:
    glUniformMatrix2fv(u.location, 1, GL_FALSE, f);
    break;
  case GL_FLOAT_MAT4:
    glUniformMatrix4fv(u.location, 1, GL_FALSE, f);
    break;
  case GL_INT_VEC2:
    glUniform2iv(u.location, 1, i);
    break;
  default:
    glUniform1iv(u.location, 1, i);
  }
}

void GLAPIENTRY ReplayedDraws::Hook(GLenum mode, const GLsizei* counts, GLenum type,
                                    const void* const* firsts, GLsizei draws) {
  ReplayedDraws& self = *Recorder;
  if (self.Draws_.empty()) {
    glGetIntegerv(GL_CURRENT_PROGRAM, &self.Program_);
    glGetIntegerv(GL_VERTEX_ARRAY_BINDING, &self.VertexArray_);
    glGetIntegerv(GL_DRAW_FRAMEBUFFER_BINDING, &self.Framebuffer_);
    glGetIntegerv(GL_VIEWPORT, self.Viewport_);
    self.Culled_ = glIsEnabled(GL_CULL_FACE) == GL_TRUE;
    glGetIntegerv(GL_CULL_FACE_MODE, &self.CulledFace_);
    self.Srgb_ = glIsEnabled(GL_FRAMEBUFFER_SRGB) == GL_TRUE;
    GLint active = 0;
    glGetIntegerv(GL_ACTIVE_TEXTURE, &active);
    for (const Uniform& uniform : UniformsOf(self.Program_)) {
      if (uniform.type != GL_SAMPLER_2D && uniform.type != GL_SAMPLER_2D_ARRAY &&
          uniform.type != GL_INT_SAMPLER_2D_ARRAY) {
        continue;
      }
      Texture texture{uniform.integers[0], GL_TEXTURE_2D, 0};
      glActiveTexture(GL_TEXTURE0 + GLenum(texture.unit));
      if (uniform.type == GL_SAMPLER_2D) {
        glGetIntegerv(GL_TEXTURE_BINDING_2D, &texture.name);
      } else {
        texture.target = GL_TEXTURE_2D_ARRAY;
        glGetIntegerv(GL_TEXTURE_BINDING_2D_ARRAY, &texture.name);
      }
      self.Textures_.push_back(texture);
    }
    glActiveTexture(GLenum(active));
  }
  Draw draw;
  draw.mode = mode;
  draw.counts.assign(counts, counts + draws);
  draw.type = type;
  draw.firsts.assign(firsts, firsts + draws);
  const std::vector<Uniform> now = UniformsOf(self.Program_);
  for (std::size_t i = 0; i < now.size(); ++i) {
    if (i >= self.Before_.size() || now[i].floats != self.Before_[i].floats ||
        now[i].integers != self.Before_[i].integers) {
      draw.uniforms.push_back(now[i]);
    }
  }
  self.Before_ = now;
  self.Draws_.push_back(std::move(draw));
  Original(mode, counts, type, firsts, draws);
}

void ReplayedDraws::Begin() {
  *this = ReplayedDraws();
  Recorder = this;
  Original = __glewMultiDrawElements;
  __glewMultiDrawElements = reinterpret_cast<PFNGLMULTIDRAWELEMENTSPROC>(&ReplayedDraws::Hook);
}

void ReplayedDraws::End() {
  __glewMultiDrawElements = Original;
  Recorder = nullptr;
}

std::size_t ReplayedDraws::Triangles() const {
  std::size_t triangles = 0;
  for (const Draw& draw : this->Draws_) {
    for (const GLsizei count : draw.counts) {
      triangles += std::size_t(count) / 3;
    }
  }
  return triangles;
}

void ReplayedDraws::Replay(const float clear[4]) const {
  glBindFramebuffer(GL_DRAW_FRAMEBUFFER, GLuint(this->Framebuffer_));
  glViewport(this->Viewport_[0], this->Viewport_[1], this->Viewport_[2], this->Viewport_[3]);
  glDepthMask(GL_TRUE);
  glClearColor(clear[0], clear[1], clear[2], clear[3]);
  glClearDepth(0.0);
  glClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  glEnable(GL_DEPTH_TEST);
  glDepthFunc(GL_GEQUAL);
  glDisable(GL_BLEND);
  if (this->Culled_) {
    glEnable(GL_CULL_FACE);
    glCullFace(GLenum(this->CulledFace_));
  }
  if (this->Srgb_) {
    glEnable(GL_FRAMEBUFFER_SRGB);
  }
  glUseProgram(GLuint(this->Program_));
  for (const Texture& texture : this->Textures_) {
    glActiveTexture(GL_TEXTURE0 + GLenum(texture.unit));
    glBindTexture(texture.target, GLuint(texture.name));
  }
  glBindVertexArray(GLuint(this->VertexArray_));
  for (const Draw& draw : this->Draws_) {
    for (const Uniform& uniform : draw.uniforms) {
      Set(uniform);
    }
    Original(draw.mode, draw.counts.data(), draw.type, draw.firsts.data(),
             GLsizei(draw.counts.size()));
  }
  glBindVertexArray(0);
  glDisable(GL_CULL_FACE);
  glDisable(GL_FRAMEBUFFER_SRGB);
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  glDepthFunc(GL_LEQUAL);
}

} // namespace dspace::bench
