// Posts made of a formula, for tests: any size, and every height is known.
#ifndef DSPACE_TEST_FORMULAPOSTS_H
#define DSPACE_TEST_FORMULAPOSTS_H

#include <cmath>
#include <functional>
#include <limits>
#include <string>

#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/posts/PostSource.h>
#include <dspace/posts/RasterPosts.h>

namespace dspace::testing {

// A post of any level has the formula's value where it stands: no means.
class FormulaPosts : public PostSource {
public:
  using Formula = std::function<double(double column, double row)>;
  FormulaPosts(std::int64_t columns, std::int64_t rows, bool periodic, Formula formula,
               int cells = 124)
      : Formula_(std::move(formula)) {
    this->Lattice_.columns = columns;
    this->Lattice_.rows = rows;
    this->Lattice_.periodic = periodic;
    this->Lattice_.levels = LevelsFor(this->Lattice_, CoarsestFor(cells));
  }
  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  double At(double column, double row) const { return this->Formula_(column, row); }
  void Read(const PostBlock& block, float* heights) const override {
    const PostLattice& lattice = this->Lattice_;
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        const std::int64_t c = lattice.Wrapped(block.level, block.column + i);
        const std::int64_t r = block.row + j;
        const bool inside = c >= 0 && c < lattice.ColumnsAt(block.level) && r >= 0 &&
                            r < lattice.RowsAt(block.level);
        heights[std::size_t(j) * block.width + i] =
            inside ? float(this->Formula_(double(lattice.ColumnPlace(block.level, c)),
                                          double(lattice.RowPlace(block.level, r))))
                   : std::numeric_limits<float>::quiet_NaN();
      }
    }
  }

private:
  std::string Name_ = "formula";
  PostLattice Lattice_;
  Formula Formula_;
};

} // namespace dspace::testing

#endif
