// ReadVrml: VRML 2.0, VRML 1.0 and Inventor text, plain or gzip-compressed, with what they inline.
#include <dspace/import/files/Importers.h>
#include <dspace/import/vrml/VrmlBuilder.h>
#include <dspace/import/vrml/VrmlCoin.h>

namespace dspace {

Model ReadVrml(const std::string& path, const ImportOptions& options) {
  CoinSession session;
  return VrmlBuilder(path, options, session).Run();
}

} // namespace dspace
