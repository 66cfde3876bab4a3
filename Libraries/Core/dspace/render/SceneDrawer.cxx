#include <dspace/render/SceneDrawer.h>

#include <algorithm>
#include <cstring>
#include <string>

#include "vtk_glew.h"

#include "Background_frag.h"
#include "Copy_frag.h"
#include "Downsample_frag.h"
#include "Instance_vert.h"
#include "Label_frag.h"
#include "Screen_vert.h"
#include "Surface_frag.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/Error.h>

namespace dspace {
namespace {

// Texture units above those that VTK hands out.
constexpr int ColorUnit = 13;
constexpr int OpaqueDepthUnit = 14;
constexpr int PeeledDepthUnit = 15;
constexpr int MaximumLights = 8;

// The GLSL version, and one definition a feature, in place of the marker.
std::string Versioned(const char* source, const std::string& defines) {
  const std::string marker = "//DSPACE::Version";
  std::string text = source;
  const auto at = text.find(marker);
  return text.replace(at, marker.size(), "#version 330 core\n" + defines);
}

vtkShaderProgram* Ready(vtkDspaceHubWindow* window, const std::string& vertex,
                        const std::string& fragment) {
  vtkShaderProgram* program =
      window->GetShaderCache()->ReadyShaderProgram(vertex.c_str(), fragment.c_str(), "");
  if (!program) {
    throw Error(Error::Kind::Internal, "shader", "the OpenGL driver refused to compile it");
  }
  return program;
}

void BindTexture(vtkDspaceHubWindow* window, int unit, unsigned int target, unsigned int name) {
  window->GetState()->vtkglActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target, name);
}

// Writes through sRGB encoding while it lives; VTK's own drawing expects none.
class EncodeSrgb {
public:
  EncodeSrgb() { glEnable(GL_FRAMEBUFFER_SRGB); }
  EncodeSrgb(const EncodeSrgb&) = delete;
  EncodeSrgb& operator=(const EncodeSrgb&) = delete;
  ~EncodeSrgb() { glDisable(GL_FRAMEBUFFER_SRGB); }
};

// Reversed depth while it lives.
class ReversedDepth {
public:
  explicit ReversedDepth(vtkOpenGLState* state) : State_(state) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglDepthFunc(GL_GEQUAL);
  }
  ReversedDepth(const ReversedDepth&) = delete;
  ReversedDepth& operator=(const ReversedDepth&) = delete;
  ~ReversedDepth() {
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    this->State_->vtkglDepthFunc(GL_LEQUAL);
    this->State_->vtkglDepthMask(GL_TRUE);
  }

private:
  vtkOpenGLState* State_;
};

} // namespace

SceneDrawer::SceneDrawer(vtkDspaceHubWindow* window, GpuStore& store, RenderStatistics& statistics)
    : Window_(window), Store_(store), Statistics_(statistics) {}

SceneDrawer::~SceneDrawer() {
  this->Release();
}

void SceneDrawer::Release() {
  for (auto& layer : this->Layers_) {
    layer.reset();
  }
  this->Sum_.reset();
  if (this->Window_->GetContext()) {
    this->Window_->MakeCurrent();
    if (this->InstanceBuffer_) {
      glDeleteBuffers(1, &this->InstanceBuffer_);
    }
    if (this->EmptyArray_) {
      glDeleteVertexArrays(1, &this->EmptyArray_);
    }
    if (this->Query_) {
      glDeleteQueries(1, &this->Query_);
    }
  }
  this->InstanceBuffer_ = this->EmptyArray_ = this->Query_ = 0;
  this->Uploaded_.clear();
  this->InstanceCapacity_ = 0;
  this->Surfaces_.clear();
  this->Screens_.clear();
}

vtkShaderProgram* SceneDrawer::SurfaceProgram(unsigned features) {
  vtkShaderProgram*& program = this->Surfaces_[features];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
    return program;
  }
  std::string defines;
  const auto define = [&](Feature feature, const char* name) {
    if (features & feature) {
      defines += std::string("#define ") + name + "\n";
    }
  };
  define(Lit, "DSPACE_LIT");
  define(Texture, "DSPACE_TEXTURE");
  define(VertexColor, "DSPACE_VERTEX_COLOR");
  define(Billboard, "DSPACE_BILLBOARD");
  define(Peel, "DSPACE_PEEL");
  define(Label, "DSPACE_LABEL");
  define(Emissive, "DSPACE_EMISSIVE");
  define(Specular, "DSPACE_SPECULAR");
  define(PlacedLights, "DSPACE_PLACED_LIGHTS");
  defines += "#define DSPACE_LIGHT_COUNT " + std::to_string(features >> LightShift) + "\n";
  program = Ready(this->Window_, Versioned(Instance_vert, defines),
                  Versioned(features & Label ? Label_frag : Surface_frag, defines));
  return program;
}

vtkShaderProgram* SceneDrawer::ScreenProgram(const char* fragmentSource,
                                             const std::string& defines) {
  vtkShaderProgram*& program = this->Screens_[{fragmentSource, defines}];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
  } else {
    program = Ready(this->Window_, Versioned(Screen_vert, ""), Versioned(fragmentSource, defines));
  }
  return program;
}

void SceneDrawer::DrawTriangleOverScreen() {
  if (!this->EmptyArray_) {
    glGenVertexArrays(1, &this->EmptyArray_);
  }
  glBindVertexArray(this->EmptyArray_);
  glDrawArrays(GL_TRIANGLES, 0, 3);
  glBindVertexArray(0);
}

void SceneDrawer::Upload(const DrawList& list) {
  const std::vector<DrawInstance>& instances = list.Instances();
  const std::size_t bytes = instances.size() * sizeof(DrawInstance);
  if (!this->InstanceBuffer_) {
    glGenBuffers(1, &this->InstanceBuffer_);
  }
  const bool same =
      this->InstanceCapacity_ > 0 && this->Uploaded_.size() == instances.size() &&
      (bytes == 0 || std::memcmp(this->Uploaded_.data(), instances.data(), bytes) == 0);
  if (!same) {
    glBindBuffer(GL_ARRAY_BUFFER, this->InstanceBuffer_);
    // A new store each time lets the driver keep drawing from the old one.
    this->InstanceCapacity_ = std::max(bytes, sizeof(DrawInstance));
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(this->InstanceCapacity_), nullptr,
                 GL_STREAM_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes), instances.data());
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    this->Uploaded_ = instances;
    this->Statistics_.instanceBytesUploaded += bytes;
  }
}

void SceneDrawer::SetView(vtkShaderProgram* program, const DrawList& list, const DrawView& view,
                          int samples) {
  const Eigen::Matrix4f clip = view.projection.ClipFromView(view.width, view.height).cast<float>();
  Eigen::Matrix4f columns = clip; // column-major, as OpenGL reads it
  program->SetUniformMatrix4x4("VCDCMatrix", columns.data());
  // Of the picture, not of the n x n samples that are drawn of it.
  const float pixel[2] = {2.0f * static_cast<float>(samples) / static_cast<float>(view.width),
                          2.0f * static_cast<float>(samples) / static_cast<float>(view.height)};
  program->SetUniform2f("pixelNDC", pixel);
  program->SetUniformi("colorTexture", ColorUnit);
  program->SetUniformi("opaqueDepth", OpaqueDepthUnit);
  program->SetUniformi("peeledDepth", PeeledDepthUnit);
  program->SetUniformi("firstLayer", this->FirstLayer_);
  program->SetUniformi("cameraParallel",
                       view.projection.kind == Projection::Kind::Orthographic ? 1 : 0);
  program->SetUniform3f("ambientLight", list.Ambient().data());

  const int count = std::min<int>(static_cast<int>(list.Lights().size()), MaximumLights);
  if (count == 0 || !program->IsUniformUsed("lightColor")) {
    return;
  }
  int kind[MaximumLights] = {};
  float color[MaximumLights][3] = {};
  float direction[MaximumLights][3] = {};
  float position[MaximumLights][3] = {};
  float attenuation[MaximumLights][3] = {};
  float cosCone[MaximumLights] = {};
  for (int i = 0; i < count; ++i) {
    const DrawLight& light = list.Lights()[i];
    kind[i] = static_cast<int>(light.kind);
    cosCone[i] = light.cosCone;
    std::copy(light.color.begin(), light.color.end(), color[i]);
    std::copy(light.direction.begin(), light.direction.end(), direction[i]);
    std::copy(light.position.begin(), light.position.end(), position[i]);
    std::copy(light.attenuation.begin(), light.attenuation.end(), attenuation[i]);
  }
  program->SetUniform1iv("lightKind", count, kind);
  program->SetUniform3fv("lightColor", count, color);
  program->SetUniform3fv("lightDirectionVC", count, direction);
  program->SetUniform3fv("lightPositionVC", count, position);
  program->SetUniform3fv("lightAttenuation", count, attenuation);
  program->SetUniform1fv("lightCosCone", count, cosCone);
}

void SceneDrawer::DrawBatches(const DrawList& list, const DrawView& view, bool translucent,
                              unsigned features, int samples) {
  vtkOpenGLState* state = this->Window_->GetState();
  std::map<vtkShaderProgram*, bool> prepared;
  const bool labels = (features & Label) != 0;
  const auto lights = std::min<std::size_t>(list.Lights().size(), MaximumLights);
  unsigned lighting = Lit | static_cast<unsigned>(lights << LightShift);
  for (std::size_t i = 0; i < lights; ++i) {
    lighting |= list.Lights()[i].kind == Light::Kind::Directional ? 0u : PlacedLights;
  }
  for (const DrawBatch& batch : list.Batches()) {
    if (!labels && batch.translucent != translucent) {
      continue;
    }
    const GpuMesh& mesh = this->Store_.MeshOf(batch.mesh);
    unsigned wanted = features;
    wanted |= batch.billboard ? Billboard : 0u;
    wanted |= batch.texture ? Texture : 0u;
    if (!labels) {
      wanted |= batch.lit ? lighting : 0u;
      wanted |= batch.lit && batch.specular ? Specular : 0u;
      wanted |= batch.emissive ? Emissive : 0u;
      wanted |= mesh.hasColors ? VertexColor : 0u;
    }
    vtkShaderProgram* program = this->SurfaceProgram(wanted);
    if (!prepared[program]) {
      this->SetView(program, list, view, samples);
      prepared[program] = true;
    }
    if (batch.texture) {
      const unsigned int texture = this->Store_.TextureOf(batch.texture, batch.repeatTexture);
      BindTexture(this->Window_, ColorUnit, GL_TEXTURE_2D, texture);
    }
    if (mesh.mode == GL_LINES || batch.wireframe) {
      state->vtkglLineWidth(batch.lineWidth * static_cast<float>(samples));
    }
    if (mesh.mode == GL_POINTS) {
      state->vtkglPointSize(batch.pointSize * static_cast<float>(samples));
    }
    if (batch.wireframe) {
      glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    }
    if (batch.solid) { // half of its triangles need no filling
      state->vtkglEnable(GL_CULL_FACE);
      state->vtkglCullFace(batch.mirrored ? GL_FRONT : GL_BACK);
    } else {
      state->vtkglDisable(GL_CULL_FACE);
    }
    glBindVertexArray(mesh.vertexArray);
    glBindVertexBuffer(InstanceBinding, this->InstanceBuffer_,
                       static_cast<GLintptr>(batch.first * sizeof(DrawInstance)),
                       sizeof(DrawInstance));
    glDrawElementsInstanced(mesh.mode, mesh.indexCount, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(batch.count));
    ++this->Statistics_.drawCalls;
    if (batch.wireframe) {
      glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    }
  }
  state->vtkglDisable(GL_CULL_FACE);
  state->vtkglCullFace(GL_BACK);
  glBindVertexArray(0);
}

void SceneDrawer::Clear(const Background& background) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->vtkglClearDepth(0.0);
  // Without sRGB encoding a clear colour is the display value itself.
  state->vtkglClearColor(static_cast<float>(background.bottom[0]),
                         static_cast<float>(background.bottom[1]),
                         static_cast<float>(background.bottom[2]), 1.0f);
  state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
}

void SceneDrawer::DrawBackground(const Background& background, int height) {
  if (background.bottom == background.top) {
    return; // the clear colour is it
  }
  vtkShaderProgram* program = this->ScreenProgram(Background_frag);
  program->SetUniform3f("bottomColor", background.bottom.data());
  program->SetUniform3f("topColor", background.top.data());
  program->SetUniformf("height", static_cast<float>(height));
  this->DrawTriangleOverScreen(); // at depth 0: only where nothing was drawn
}

void SceneDrawer::DrawColor(const DrawList& list, const DrawView& view, RenderTarget& target,
                            int samples, const Background* background) {
  vtkOpenGLState* state = this->Window_->GetState();
  const EncodeSrgb encode;
  const ReversedDepth reversed(state);
  this->Statistics_.drawCalls = 0;
  this->Statistics_.trianglesDrawn = list.TriangleCount();
  this->Statistics_.translucentLayers = 0;
  this->Upload(list);
  state->vtkglDisable(GL_BLEND);
  this->DrawBatches(list, view, false, 0, samples);
  if (background) {
    this->DrawBackground(*background, target.Height());
  }
  const auto& batches = list.Batches();
  if (!batches.empty() && batches.back().translucent) { // they stand last
    this->PeelTranslucent(list, view, target, samples);
  }
  state->vtkglEnable(GL_BLEND);
}

void SceneDrawer::PeelTranslucent(const DrawList& list, const DrawView& view, RenderTarget& target,
                                  int samples) {
  vtkOpenGLState* state = this->Window_->GetState();
  if (!this->Sum_) {
    for (auto& layer : this->Layers_) {
      layer = std::make_unique<RenderTarget>(this->Window_, RenderTarget::Format::Linear, true);
    }
    this->Sum_ = std::make_unique<RenderTarget>(this->Window_, RenderTarget::Format::Linear, false);
    glGenQueries(1, &this->Query_);
  }
  for (auto& layer : this->Layers_) {
    layer->Resize(target.Width(), target.Height());
  }
  this->Sum_->Resize(target.Width(), target.Height());

  state->PushFramebufferBindings();
  this->Sum_->Bind();
  state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  state->vtkglClear(GL_COLOR_BUFFER_BIT);
  BindTexture(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, target.Depth());
  int layers = 0;
  for (; layers < MaximumLayers; ++layers) {
    RenderTarget& layer = *this->Layers_[layers % 2];
    BindTexture(this->Window_, PeeledDepthUnit, GL_TEXTURE_2D,
                this->Layers_[(layers + 1) % 2]->Depth());
    this->FirstLayer_ = layers == 0 ? 1 : 0;
    layer.Bind();
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDisable(GL_BLEND);
    state->vtkglClearDepth(0.0);
    state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, this->Query_);
    this->DrawBatches(list, view, true, Peel, samples);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint any = 0;
    glGetQueryObjectuiv(this->Query_, GL_QUERY_RESULT, &any);
    if (!any) {
      break;
    }
    // What lies behind shows through what the layers before it let pass.
    this->Sum_->Bind();
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglEnable(GL_BLEND);
    state->vtkglBlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_ONE, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    BindTexture(this->Window_, ColorUnit, GL_TEXTURE_2D, layer.Color());
    this->ScreenProgram(Copy_frag)->SetUniformi("source", ColorUnit);
    this->DrawTriangleOverScreen();
  }
  this->Statistics_.translucentLayers = layers;
  state->vtkglClearDepth(1.0);
  state->PopFramebufferBindings();
  state->vtkglViewport(0, 0, target.Width(), target.Height());
  state->vtkglScissor(0, 0, target.Width(), target.Height());
  if (layers > 0) {
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglEnable(GL_BLEND);
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    BindTexture(this->Window_, ColorUnit, GL_TEXTURE_2D, this->Sum_->Color());
    this->ScreenProgram(Copy_frag)->SetUniformi("source", ColorUnit);
    this->DrawTriangleOverScreen();
    state->vtkglEnable(GL_DEPTH_TEST);
  }
  state->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                                GL_ONE_MINUS_SRC_ALPHA);
}

void SceneDrawer::DrawLabels(const DrawList& list, const DrawView& view, RenderTarget& target) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  {
    const ReversedDepth reversed(state);
    state->vtkglDisable(GL_BLEND);
    const GLuint nothing[4] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    state->vtkglClearDepth(0.0);
    state->vtkglClear(GL_DEPTH_BUFFER_BIT);
    state->vtkglClearDepth(1.0);
    this->Upload(list);
    this->DrawBatches(list, view, false, Label, 1);
    state->vtkglEnable(GL_BLEND);
  }
  state->PopFramebufferBindings();
}

void SceneDrawer::Downsample(const RenderTarget& source, RenderTarget& target, int samples) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  {
    const EncodeSrgb encode;
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglDisable(GL_BLEND);
    BindTexture(this->Window_, ColorUnit, GL_TEXTURE_2D, source.Color());
    // A number in the source lets a software renderer unroll the loops.
    const std::string defines = "#define DSPACE_SAMPLES " + std::to_string(samples) + "\n";
    this->ScreenProgram(Downsample_frag, defines)->SetUniformi("source", ColorUnit);
    this->DrawTriangleOverScreen();
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglEnable(GL_BLEND);
  }
  state->PopFramebufferBindings();
}

} // namespace dspace
