// The Model that a walk over VRML nodes makes, with its limits and caches. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_BUILDER_H
#define DSPACE_IMPORT_VRML_BUILDER_H

#include <dspace/import/vrml/VrmlCoin.h>
#include <dspace/import/vrml/VrmlFaces.h>

#include <dspace/import/files/ModelReader.h>
#include <dspace/import/files/TextureBudget.h>
#include <dspace/import/model/Model.h>

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <vector>

namespace dspace {

class VrmlBuilder {
public:
  VrmlBuilder(const std::string& path, const ImportOptions& options, CoinSession& session);

  // Walks the file itself; once.
  Model Run();

  // Identity of a mesh or material: addresses of Coin's nodes and numbers. Equal keys share.
  using Key = std::vector<std::uintptr_t>;

  // Counts a step of the walk. Throws Error(Resource) beyond 2,000,000 steps or 512 levels.
  void Step(const VrmlFile& file, int depth);
  int AddNode(int parent, const std::string& name, const Eigen::Affine3d& local);
  void SetRange(int node, const DistanceRange& range);
  // Hangs the mesh of that key on the node; false when there is none yet.
  bool UseMesh(int node, const Key& key);
  // Stores a mesh, unless it is empty, and hangs it on the node.
  // Throws Error(Resource) beyond ImportOptions::maximumTriangles.
  void AddMesh(int node, const Key& key, Mesh mesh);
  // Index of the material of that key, or -1.
  int FindMaterial(const Key& key) const;
  int AddMaterial(const Key& key, const Material& material);

  // First of `urls` that can be read as an image, once a file; otherwise null and a warning.
  std::shared_ptr<const Image> Texture(const VrmlFile& file, const std::vector<std::string>& urls);
  // Walks the first of `urls` that exists below the node; otherwise a warning.
  void Inline(const VrmlFile& file, const std::vector<std::string>& urls, int parent, int depth);

  // Warnings of one kind ("textures are left out") and file become one when there are many.
  void Warn(const VrmlFile& file, const std::string& kind, const std::string& name,
            const std::string& message);
  void WarnShape(const VrmlFile& file, const std::string& what, const VrmlComplaints& complaints);

private:
  struct Warnings {
    std::string kind;
    std::string file;
    std::string names;                 // the first few
    std::vector<std::string> messages; // the first few
    std::size_t count = 0;
  };

  void AppendWarnings();
  void WalkFile(const std::string& path, int parent, int depth);
  const VrmlFile& Open(const std::string& path);

  ImportOptions Options_;
  CoinSession& Session_;
  Model Model_;
  std::map<std::string, VrmlFile> Files_; // by canonical path
  std::vector<std::string> OpenFiles_;    // being walked, outermost first
  std::map<std::string, std::shared_ptr<const Image>> Textures_;
  TextureBudget TextureBudget_;
  std::map<Key, int> Meshes_; // -1: empty
  std::map<Key, int> Materials_;
  std::map<std::string, int> LeftOut_; // by type of node, of all files
  std::set<std::string> Warned_;
  std::vector<Warnings> Warnings_; // in the order of each kind's first
  std::size_t Steps_ = 0;
  std::size_t Triangles_ = 0;
};

} // namespace dspace

#endif
