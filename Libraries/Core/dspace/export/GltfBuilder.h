// Collects the arrays, images, materials and meshes of a glTF file; each is stored once.
#ifndef DSPACE_EXPORT_GLTF_BUILDER_H
#define DSPACE_EXPORT_GLTF_BUILDER_H

#include <map>
#include <memory>
#include <string>
#include <vector>

#include <tiny_gltf.h>

#include <dspace/import/model/Model.h>

namespace dspace {

class GltfBuilder {
public:
  GltfBuilder();

  tinygltf::Model& File() { return this->File_; }

  // Index of a mesh of one primitive with this look (PartLook.h). Equal meshes are those of one
  // address: the builder keeps them.
  int MeshOf(const std::shared_ptr<const Mesh>& mesh, const Material& look);

  // Index of an accessor of floats, `components` (1, 3, 4) a value.
  int Floats(const std::vector<float>& values, int components, bool withBounds = false,
             int target = 0);

  // The finished file. Throws Error(Resource) naming `object` at 4 GiB.
  std::string Bytes(const std::string& object);

private:
  struct Arrays {
    std::shared_ptr<const Mesh> mesh;
    int position = -1;
    int normal = -1;
    int tcoord = -1;
    int color = -1;
    int index = -1;
  };
  int View(const void* data, std::size_t bytes, int target);
  int Accessor(int view, int componentType, int type, std::size_t count);
  const Arrays& ArraysOf(const std::shared_ptr<const Mesh>& mesh);
  int ImageOf(const std::shared_ptr<const Image>& image);
  int TextureOf(const std::shared_ptr<const Image>& image, bool repeat);
  int MaterialOf(const Material& look, const Mesh& mesh);

  tinygltf::Model File_;
  std::vector<unsigned char> Data_;
  std::map<const Mesh*, Arrays> Arrays_;
  std::map<std::pair<const Image*, bool>, int> Textures_;
  std::vector<std::shared_ptr<const Image>> Images_; // of the file, in its order
  std::map<std::string, int> Materials_;             // by their values
  std::map<std::pair<const Mesh*, int>, int> Meshes_;
};

} // namespace dspace

#endif
