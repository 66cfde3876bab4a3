// Meshes and textures on the GPU: each once, as long as it is referenced.
#ifndef DSPACE_RENDER_GPU_STORE_H
#define DSPACE_RENDER_GPU_STORE_H

#include <memory>
#include <unordered_map>

#include <Eigen/Geometry>

#include <dspace/import/model/Model.h>
#include <dspace/render/Capture.h>

namespace dspace {

// Where a vertex array takes its instances from; 0 to 11 belong to attributes bound the old way.
constexpr unsigned int InstanceBinding = 12;

// Vertex array, buffers and counts of one mesh; interleaving follows Instance.vert.glsl.
struct GpuMesh {
  unsigned int vertexArray = 0;
  unsigned int vertexBuffer = 0;
  unsigned int indexBuffer = 0;
  unsigned int mode = 0; // GL_TRIANGLES, GL_LINES, GL_POINTS
  int indexCount = 0;
  std::uint64_t bytes = 0;
  bool hasColors = false;
  Eigen::AlignedBox3f bounds;             // of the positions
  std::vector<Eigen::AlignedBox3f> parts; // PartsOf(mesh)
};

// Every function needs the context that the store was first used with to be current.
class GpuStore {
public:
  explicit GpuStore(RenderStatistics& statistics) : Statistics_(statistics) {}
  GpuStore(const GpuStore&) = delete;
  GpuStore& operator=(const GpuStore&) = delete;
  ~GpuStore() = default; // Release() first: it needs the context

  // Uploads on first use.
  const GpuMesh& MeshOf(const std::shared_ptr<const Mesh>& mesh);
  // OpenGL name of a mip-mapped texture. Its values are sRGB, or numbers (normals). Throws
  // Error(Resource) when it is too large.
  enum class Values { Srgb, Numbers };
  unsigned int TextureOf(const std::shared_ptr<const Image>& image, bool repeat,
                         Values values = Values::Srgb);
  // Frees entries that only the store references.
  void Collect();
  // Frees everything.
  void Release();

private:
  struct MeshEntry {
    std::weak_ptr<const Mesh> mesh;
    GpuMesh gpu;
  };
  struct TextureEntry {
    std::weak_ptr<const Image> image;
    unsigned int texture = 0;
    std::uint64_t bytes = 0;
  };
  void Free(MeshEntry& entry);
  void Free(TextureEntry& entry);

  RenderStatistics& Statistics_;
  std::unordered_map<const Mesh*, MeshEntry> Meshes_;
  std::unordered_map<const Image*, TextureEntry> Textures_[4]; // + 1: repeated; + 2: numbers
};

} // namespace dspace

#endif
