// The posts of a grid in memory as a source of posts. Not for public headers.
#ifndef DSPACE_TERRAIN_GRIDPOSTS_H
#define DSPACE_TERRAIN_GRIDPOSTS_H

#include <string>

#include <dspace/posts/HeightGrid.h>
#include <dspace/posts/PostSource.h>

namespace dspace {

// Level 0 only. Post (c, r) is the grid's; its height is rounded to a float.
class GridPosts : public PostSource {
public:
  // `name` is for messages. Keeps a reference to `grid`, which must outlive it.
  GridPosts(std::string name, const HeightGrid& grid);

  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override;

private:
  std::string Name_;
  const HeightGrid& Grid_;
  PostLattice Lattice_;
};

} // namespace dspace

#endif
