#include <dspace/kernels/SpkArray.h>

#include <dspace/Error.h>
#include <dspace/kernels/ChebyshevRecords.h>
#include <dspace/kernels/SpkDifferences.h>
#include <dspace/kernels/SpkNodes.h>

namespace dspace {
namespace {

constexpr double Kilometre = 1000.0;

class SpkChebyshev final : public SpkArray {
public:
  SpkChebyshev(const DafFile& file, const DafFile::Array& array, int functions)
      : Records_(file, array, functions) {}

  State At(double tdb) const override {
    State state;
    this->Records_.At(tdb, state.position, state.velocity);
    state.position *= Kilometre;
    state.velocity *= Kilometre;
    return state;
  }

private:
  ChebyshevRecords Records_;
};

} // namespace

bool SpkArray::IsRead(int type) {
  switch (type) {
  case 1:
  case 2:
  case 3:
  case 8:
  case 9:
  case 13:
  case 21:
    return true;
  default:
    return false;
  }
}

std::unique_ptr<SpkArray> SpkArray::Open(const DafFile& file, const DafFile::Array& array,
                                         int type) {
  switch (type) {
  case 1:
  case 21:
    return std::make_unique<SpkDifferences>(file, array, type);
  case 2:
    return std::make_unique<SpkChebyshev>(file, array, 3);
  case 3:
    return std::make_unique<SpkChebyshev>(file, array, 6);
  case 8:
  case 9:
  case 13:
    return std::make_unique<SpkNodes>(file, array, type);
  default:
    throw Error(Error::Kind::Unsupported, file.Label(),
                "segment '" + array.name + "' is of SPK type " + std::to_string(type) +
                    "; accepted: types 1, 2, 3, 8, 9, 13 and 21");
  }
}

} // namespace dspace
