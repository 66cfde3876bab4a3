// Extensions that a glTF file requires: read, drawn without, or rejected by name.
#include "GltfTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

TEST(GltfExtensions, RequiredExtensionsThatOnlyLookDifferentAreWarnings) {
  const TempFolder folder;
  const auto with = [&](const std::string& required) {
    return WriteQuad(folder, Replaced(Quad, "\"scene\": 0",
                                      "\"extensionsRequired\": [" + required + "], \"scene\": 0"));
  };
  const Model model =
      ReadModel(with("\"KHR_materials_transmission\", \"KHR_materials_variants\", "
                     "\"KHR_lights_punctual\", \"KHR_texture_basisu\", \"EXT_texture_webp\""));
  EXPECT_EQ(model.TriangleCount(), 4u);
  ASSERT_EQ(model.warnings.size(), 1u);
  EXPECT_TRUE(HasWarning(model.warnings, "'KHR_materials_transmission', 'KHR_materials_variants', "
                                         "'KHR_texture_basisu'; its geometry is drawn without"));
  // What hides geometry is an error that names it.
  for (const char* name :
       {"EXT_meshopt_compression", "KHR_meshopt_compression", "ACME_compression"}) {
    ExpectReadError(Error::Kind::Unsupported, name, with("\"" + std::string(name) + "\""));
  }
}
