// Meshes, materials and textures of exported scenes, opened by assimp.
#include <cstring>
#include <filesystem>

#include "ExportTestSupport.h"

using namespace dspace;
using namespace dspace::testing;

using GltfBuilderTest = SceneExportTest;

TEST_F(GltfBuilderTest, MeshesAreStoredOnce) {
  const auto mesh = std::make_shared<const Mesh>(MakeSphere(1.0, 64));
  const auto material = std::make_shared<const Material>();
  for (int i = 0; i < 20; ++i) {
    GraphicsObject object;
    object.name = "ball " + std::to_string(i);
    object.X_FO.translation().x() = i;
    object.levels = {{{Part{mesh, material}}, 0.0}};
    this->S.AddObject(std::move(object));
  }
  this->S.SetObjectMaterial(3, [] {
    MaterialOverride red;
    red.color = {1, 0, 0};
    return red;
  }());
  this->Export();
  const std::size_t arrays =
      4 * (2 * mesh->positions.size() + 2 * mesh->tcoords.size() / 2 + mesh->indices.size());
  EXPECT_LT(std::filesystem::file_size(this->Path), arrays + 20000);
  const ExportedFile file(this->Path);
  EXPECT_EQ(file.Scene->mNumMeshes, 2u); // one a material
  EXPECT_EQ(file.Mesh("ball 7").mNumFaces, mesh->PrimitiveCount());
}

TEST_F(GltfBuilderTest, MaterialsAreLinear) {
  Material material;
  material.name = "paint";
  material.color = {0.5, 0.25, 1.0};
  material.opacity = 0.5;
  material.metallic = 0.75;
  material.roughness = 0.125;
  material.emissive = {0.0, 0.5, 0.0};
  this->Add("box", MakeBox({1, 1, 1}), RootFrame, material);
  material.lit = false;
  material.opacity = 1.0;
  material.emissive = {0.0, 0.0, 0.0};
  this->Add("flat", MakeBox({1, 1, 1}), RootFrame, material);
  this->Export();
  const ExportedFile file(this->Path);
  const aiMaterial& box = file.Material("box");
  aiColor4D base;
  ASSERT_EQ(box.Get(AI_MATKEY_BASE_COLOR, base), AI_SUCCESS);
  EXPECT_NEAR(base.r, Linear(0.5), 1e-6);
  EXPECT_NEAR(base.g, Linear(0.25), 1e-6);
  EXPECT_NEAR(base.b, 1.0, 1e-6);
  EXPECT_NEAR(base.a, 0.5, 1e-6);
  ai_real metallic = 0;
  ai_real roughness = 0;
  ASSERT_EQ(box.Get(AI_MATKEY_METALLIC_FACTOR, metallic), AI_SUCCESS);
  ASSERT_EQ(box.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness), AI_SUCCESS);
  EXPECT_NEAR(metallic, 0.75, 1e-6);
  EXPECT_NEAR(roughness, 0.125, 1e-6);
  aiColor3D emissive;
  ASSERT_EQ(box.Get(AI_MATKEY_COLOR_EMISSIVE, emissive), AI_SUCCESS);
  EXPECT_NEAR(emissive.g, Linear(0.5), 1e-6);
  aiString mode;
  ASSERT_EQ(box.Get(AI_MATKEY_GLTF_ALPHAMODE, mode), AI_SUCCESS);
  EXPECT_STREQ(mode.C_Str(), "BLEND");
  int shading = 0;
  ASSERT_EQ(file.Material("flat").Get(AI_MATKEY_SHADING_MODEL, shading), AI_SUCCESS);
  EXPECT_EQ(shading, int(aiShadingMode_Unlit));
  box.Get(AI_MATKEY_SHADING_MODEL, shading);
  EXPECT_NE(shading, int(aiShadingMode_Unlit));
}

TEST_F(GltfBuilderTest, TexturesLieUpright) {
  auto image = std::make_shared<Image>();
  image->name = "two rows";
  image->width = 1;
  image->height = 2;
  image->channels = 3;
  image->pixels = {255, 0, 0, 0, 0, 255}; // red above blue
  Material material;
  material.color = {1, 1, 1};
  material.texture = image;
  material.repeatTexture = false;
  this->Add("plane", MakePlane(1, 1), RootFrame, material);
  material.texture = std::make_shared<Image>(*image); // as another file would read it
  this->Add("other", MakePlane(1, 1), RootFrame, material);
  this->Export();
  const ExportedFile file(this->Path);
  ASSERT_EQ(file.Scene->mNumTextures, 1u); // stored once
  const aiTexture& texture = *file.Scene->mTextures[0];
  EXPECT_EQ(texture.mHeight, 0u); // a file: PNG
  EXPECT_EQ(std::memcmp(texture.pcData, "\x89PNG", 4), 0);
  const aiMesh& mesh = file.Mesh("plane");
  ASSERT_TRUE(mesh.HasTextureCoords(0));
  for (unsigned v = 0; v < mesh.mNumVertices; ++v) {
    // assimp gives v upwards: 1 is the first row. The plane's Y is up in the image.
    EXPECT_NEAR(mesh.mTextureCoords[0][v].y, mesh.mVertices[v].y + 0.5, 1e-6);
  }
}

TEST_F(GltfBuilderTest, LinesPointsAndVertexColors) {
  this->Add("line", MakeLineSet({{0, 0, 0}, {1, 0, 0}, {1, 2, 0}}));
  Mesh points = MakePointSet({{0, 0, 0}, {0, 0, 5}});
  points.colors = {255, 128, 0, 255, 0, 64, 255, 255};
  this->Add("points", std::move(points));
  this->Export();
  const ExportedFile file(this->Path);
  EXPECT_EQ(file.Mesh("line").mPrimitiveTypes, unsigned(aiPrimitiveType_LINE));
  EXPECT_EQ(file.Mesh("line").mNumFaces, 2u);
  const aiMesh& read = file.Mesh("points");
  EXPECT_EQ(read.mPrimitiveTypes, unsigned(aiPrimitiveType_POINT));
  ASSERT_TRUE(read.HasVertexColors(0));
  EXPECT_NEAR(read.mColors[0][0].g, Linear(128 / 255.0), 1e-6);
  EXPECT_NEAR(read.mColors[0][1].g, Linear(64 / 255.0), 1e-6);
}
