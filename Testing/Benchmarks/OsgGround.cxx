#include "OsgGround.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <stdexcept>
#include <thread>

#include <EGL/egl.h>
#include <EGL/eglext.h>
#include <osg/LightSource>
#include <osg/Material>
#include <osg/PagedLOD>
#include <osg/Program>
#include <osgDB/DatabasePager>
#include <osgDB/Registry>
#include <osgTerrain/GeometryTechnique>
#include <osgTerrain/Terrain>
#include <osgTerrain/TerrainTile>
#include <osgUtil/Statistics>
#include <osgViewer/Renderer>
#include <osgViewer/Viewer>

#include "OsgGround_frag.h"
#include "OsgGround_vert.h"

namespace dspace::bench {
namespace {

constexpr const char* Extension = "dspaceground";

// Makes tiles as osgdem's files hold them: each file the four children of a tile, which name the
// files of theirs.
class TileReader : public osgDB::ReaderWriter {
public:
  explicit TileReader(const OsgGroundOptions& options) : Options_(options) {
    this->supportsExtension(Extension, "tiles of a formula");
  }

  ReadResult readNode(const std::string& name, const Options*) const override {
    int level = 0, x = 0, y = 0;
    char end[16] = "";
    if (std::sscanf(name.c_str(), "%d_%d_%d.%15s", &level, &x, &y, end) != 4 ||
        std::string(end) != Extension) {
      return ReadResult::FILE_NOT_HANDLED;
    }
    ++this->Busy_;
    osg::ref_ptr<osg::Group> group = new osg::Group;
    for (int i = 0; i < 4; ++i) {
      const int column = 2 * x + i % 2, row = 2 * y + i / 2;
      const int cells = this->Options_.cells * this->Step(level + 1);
      if (std::max(column, row) * cells < this->Options_.side) {
        group->addChild(this->Node(level + 1, column, row));
      }
    }
    ++this->Made_;
    --this->Busy_;
    return group.release();
  }

  // The pager's own count leaves out what its threads are reading.
  bool Busy() const { return this->Busy_ > 0; }
  int Made() const { return this->Made_; }

  // The tile, and what stands for it nearby.
  osg::ref_ptr<osg::Node> Node(int level, int x, int y) const {
    osg::ref_ptr<osg::Node> tile = this->Tile(level, x, y);
    if (this->Step(level) == 1) {
      return tile;
    }
    const osg::BoundingSphere bound = tile->getBound();
    const float cut = float(this->Options_.ratio * bound.radius());
    osg::ref_ptr<osg::PagedLOD> lod = new osg::PagedLOD;
    lod->setCenter(bound.center());
    lod->setRadius(bound.radius());
    lod->addChild(tile, cut, std::numeric_limits<float>::max());
    lod->setFileName(1, std::to_string(level) + "_" + std::to_string(x) + "_" + std::to_string(y) +
                            "." + Extension);
    lod->setRange(1, 0.0f, cut);
    return lod;
  }

private:
  // Posts of the finest level between two of this one's.
  int Step(int level) const {
    int step = 1;
    while (this->Options_.cells * step < this->Options_.side) {
      step *= 2;
    }
    return step >> level;
  }

  osg::ref_ptr<osg::Node> Tile(int level, int x, int y) const {
    const int cells = this->Options_.cells;
    const int step = this->Step(level);
    const double side = this->Options_.pixel * step * cells;
    const double west = this->Options_.northWest.x() + x * side;
    const double north = this->Options_.northWest.y() - y * side;
    osg::ref_ptr<osg::HeightField> field = new osg::HeightField;
    field->allocate(unsigned(cells) + 1, unsigned(cells) + 1);
    field->setSkirtHeight(float(this->Options_.skirt * side * std::sqrt(0.5)));
    for (int r = 0; r <= cells; ++r) { // a height field's row 0 is its southern one
      for (int c = 0; c <= cells; ++c) {
        field->setHeight(
            unsigned(c), unsigned(cells - r),
            float(this->Options_.height((x * cells + c) * step, (y * cells + r) * step)));
      }
    }
    osg::ref_ptr<osgTerrain::Locator> locator = new osgTerrain::Locator;
    locator->setCoordinateSystemType(osgTerrain::Locator::PROJECTED);
    locator->setTransformAsExtents(west, north - side, west + side, north);
    osg::ref_ptr<osgTerrain::HeightFieldLayer> layer = new osgTerrain::HeightFieldLayer(field);
    layer->setLocator(locator);
    osg::ref_ptr<osgTerrain::TerrainTile> tile = new osgTerrain::TerrainTile;
    tile->setTileID(osgTerrain::TileID(level, x, y));
    tile->setLocator(locator);
    tile->setElevationLayer(layer);
    tile->setTerrainTechnique(new osgTerrain::GeometryTechnique);
    tile->init(tile->getDirtyMask(), false); // here, not in the frame that merges it
    return tile;
  }

  OsgGroundOptions Options_;
  mutable std::atomic<int> Busy_{0};
  mutable std::atomic<int> Made_{0};
};

struct Context {
  EGLDisplay display = EGL_NO_DISPLAY;
  EGLContext context = EGL_NO_CONTEXT;
  EGLSurface surface = EGL_NO_SURFACE;

  Context(int width, int height) {
    const auto getDisplay = reinterpret_cast<PFNEGLGETPLATFORMDISPLAYEXTPROC>(
        eglGetProcAddress("eglGetPlatformDisplayEXT"));
    this->display = getDisplay
                        ? getDisplay(EGL_PLATFORM_SURFACELESS_MESA, EGL_DEFAULT_DISPLAY, nullptr)
                        : EGL_NO_DISPLAY;
    const EGLint wanted[] = {EGL_SURFACE_TYPE,
                             EGL_PBUFFER_BIT,
                             EGL_RENDERABLE_TYPE,
                             EGL_OPENGL_BIT,
                             EGL_RED_SIZE,
                             8,
                             EGL_GREEN_SIZE,
                             8,
                             EGL_BLUE_SIZE,
                             8,
                             EGL_DEPTH_SIZE,
                             24,
                             EGL_SAMPLES,
                             0,
                             EGL_NONE};
    const EGLint size[] = {EGL_WIDTH, width, EGL_HEIGHT, height, EGL_NONE};
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (this->display == EGL_NO_DISPLAY || !eglInitialize(this->display, nullptr, nullptr) ||
        !eglBindAPI(EGL_OPENGL_API) ||
        !eglChooseConfig(this->display, wanted, &config, 1, &count) || count < 1) {
      throw std::runtime_error("EGL: no display with pbuffers of 24 bits of depth");
    }
    this->surface = eglCreatePbufferSurface(this->display, config, size);
    // Without a version: OpenGL with everything that was ever in it.
    this->context = eglCreateContext(this->display, config, EGL_NO_CONTEXT, nullptr);
    if (this->surface == EGL_NO_SURFACE || this->context == EGL_NO_CONTEXT) {
      throw std::runtime_error("EGL: no OpenGL context for OpenSceneGraph");
    }
  }
  ~Context() {
    eglMakeCurrent(this->display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
    eglDestroyContext(this->display, this->context);
    eglDestroySurface(this->display, this->surface);
  }
  void MakeCurrent() const {
    if (!eglMakeCurrent(this->display, this->surface, this->surface, this->context)) {
      throw std::runtime_error("EGL: OpenSceneGraph's context cannot be made current");
    }
  }
};

} // namespace

struct OsgGround::Parts {
  explicit Parts(const OsgGroundOptions& o)
      : options(o), context(o.width, o.heightPixels), reader(new TileReader(o)) {}

  osg::ref_ptr<osg::Node> Scene() const {
    osg::ref_ptr<osgTerrain::Terrain> terrain = new osgTerrain::Terrain;
    terrain->addChild(this->reader->Node(0, 0, 0));
    osg::ref_ptr<osg::Group> root = new osg::Group;
    root->addChild(terrain);
    osg::ref_ptr<osg::LightSource> source = new osg::LightSource;
    const Eigen::Vector3d to = -this->options.sun;
    source->getLight()->setPosition(osg::Vec4(float(to.x()), float(to.y()), float(to.z()), 0.0f));
    source->getLight()->setAmbient(osg::Vec4(0, 0, 0, 1));
    source->getLight()->setDiffuse(osg::Vec4(1, 1, 1, 1));
    source->getLight()->setSpecular(osg::Vec4(0, 0, 0, 1));
    root->addChild(source);
    osg::StateSet* state = root->getOrCreateStateSet();
    osg::ref_ptr<osg::Material> material = new osg::Material;
    material->setDiffuse(osg::Material::FRONT_AND_BACK, osg::Vec4(0.8f, 0.7f, 0.6f, 1.0f));
    state->setAttributeAndModes(material);
    state->setMode(GL_LIGHT0, osg::StateAttribute::ON);
    state->setMode(GL_LIGHTING, osg::StateAttribute::ON);
    return root;
  }

  OsgGroundOptions options;
  Context context;
  osg::ref_ptr<TileReader> reader;
  osg::ref_ptr<osg::Program> program = new osg::Program;
  osg::ref_ptr<osgViewer::Viewer> viewer;
};

OsgGround::OsgGround(const OsgGroundOptions& options) : Parts_(std::make_unique<Parts>(options)) {
  Parts& p = *this->Parts_;
  p.context.MakeCurrent();
  osgDB::Registry::instance()->addReaderWriter(p.reader);
  p.program->addShader(new osg::Shader(osg::Shader::VERTEX, OsgGround_vert));
  p.program->addShader(new osg::Shader(osg::Shader::FRAGMENT, OsgGround_frag));
  p.viewer = new osgViewer::Viewer;
  p.viewer->setThreadingModel(osgViewer::ViewerBase::SingleThreaded);
  p.viewer->setUpViewerAsEmbeddedInWindow(0, 0, options.width, options.heightPixels);
  p.viewer->setLightingMode(osg::View::NO_LIGHT); // the sun is the only one
  p.viewer->getDatabasePager()->setTargetMaximumNumberOfPageLOD(5000);
  osg::Camera* camera = p.viewer->getCamera();
  camera->setClearColor(osg::Vec4(0, 0, 0, 1));
  camera->setComputeNearFarMode(osg::CullSettings::DO_NOT_COMPUTE_NEAR_FAR);
  camera->setProjectionMatrixAsPerspective(options.verticalFov_deg,
                                           double(options.width) / options.heightPixels,
                                           options.nearDistance, options.farDistance);
  p.viewer->setSceneData(p.Scene());
}

OsgGround::~OsgGround() {
  Parts& p = *this->Parts_;
  p.context.MakeCurrent();
  p.viewer->getDatabasePager()->cancel();
  p.viewer->getCamera()->releaseGLObjects();
  p.viewer = nullptr;
  osgDB::Registry::instance()->removeReaderWriter(p.reader);
}

void OsgGround::Look(const Eigen::Vector3d& eye, const Eigen::Vector3d& target) {
  this->Parts_->viewer->getCamera()->setViewMatrixAsLookAt(
      osg::Vec3d(eye.x(), eye.y(), eye.z()), osg::Vec3d(target.x(), target.y(), target.z()),
      osg::Vec3d(0, 0, 1));
}

void OsgGround::LightPixels(bool on) {
  Parts& p = *this->Parts_;
  osg::StateSet* state = p.viewer->getSceneData()->getOrCreateStateSet();
  if (on) {
    state->setAttributeAndModes(p.program);
  } else {
    state->removeAttribute(p.program);
  }
}

void OsgGround::Draw() {
  this->Parts_->context.MakeCurrent();
  this->Parts_->viewer->frame();
  glFinish();
}

bool OsgGround::Pending() const {
  return this->Parts_->reader->Busy() ||
         this->Parts_->viewer->getDatabasePager()->getRequestsInProgress();
}

void OsgGround::Complete() {
  int made = -1;
  for (int calm = 0; calm < 3;) { // what has come may ask for more
    this->Draw();
    std::this_thread::sleep_for(std::chrono::milliseconds(10)); // a thread may be about to read
    const int now = this->Parts_->reader->Made();
    calm = this->Pending() || now != made ? 0 : calm + 1;
    made = now;
  }
}

std::size_t OsgGround::Triangles() const {
  auto* renderer =
      dynamic_cast<osgViewer::Renderer*>(this->Parts_->viewer->getCamera()->getRenderer());
  osgUtil::Statistics statistics;
  if (!renderer || !renderer->getSceneView(0)->getStats(statistics)) {
    throw std::runtime_error("OpenSceneGraph: no statistics of the last frame");
  }
  std::size_t triangles = 0;
  for (const auto& [mode, count] : statistics.getPrimitiveCountMap()) {
    triangles += mode == GL_TRIANGLES || mode == GL_TRIANGLE_STRIP ? count : 0;
    triangles += mode == GL_QUADS || mode == GL_QUAD_STRIP ? 2 * count : 0;
  }
  return triangles;
}

std::vector<float> OsgGround::Depth() const {
  const OsgGroundOptions& o = this->Parts_->options;
  this->Parts_->context.MakeCurrent();
  std::vector<float> buffer(std::size_t(o.width) * o.heightPixels);
  glReadPixels(0, 0, o.width, o.heightPixels, GL_DEPTH_COMPONENT, GL_FLOAT, buffer.data());
  std::vector<float> depth(buffer.size(), std::numeric_limits<float>::infinity());
  const double n = o.nearDistance, f = o.farDistance;
  for (int y = 0; y < o.heightPixels; ++y) {
    for (int x = 0; x < o.width; ++x) {
      const double d = buffer[std::size_t(o.heightPixels - 1 - y) * o.width + x];
      if (d < 1.0) {
        depth[std::size_t(y) * o.width + x] = float(n * f / (f - d * (f - n)));
      }
    }
  }
  return depth;
}

std::vector<std::uint8_t> OsgGround::Color() const {
  const OsgGroundOptions& o = this->Parts_->options;
  this->Parts_->context.MakeCurrent();
  const std::size_t row = std::size_t(3) * o.width;
  std::vector<std::uint8_t> buffer(row * o.heightPixels), color(buffer.size());
  glPixelStorei(GL_PACK_ALIGNMENT, 1);
  glReadPixels(0, 0, o.width, o.heightPixels, GL_RGB, GL_UNSIGNED_BYTE, buffer.data());
  for (int y = 0; y < o.heightPixels; ++y) {
    std::copy_n(buffer.begin() + std::ptrdiff_t(row) * (o.heightPixels - 1 - y), row,
                color.begin() + std::ptrdiff_t(row) * y);
  }
  return color;
}

} // namespace dspace::bench
