#include <dspace/import/vrml/Vrml2Shape.h>

#include <dspace/import/vrml/Vrml2Geometry.h>
#include <dspace/import/vrml/VrmlFields.h>

#include <Inventor/VRMLnodes/SoVRMLAppearance.h>
#include <Inventor/VRMLnodes/SoVRMLMaterial.h>
#include <Inventor/VRMLnodes/SoVRMLMovieTexture.h>
#include <Inventor/VRMLnodes/SoVRMLPixelTexture.h>
#include <Inventor/VRMLnodes/SoVRMLShape.h>
#include <Inventor/VRMLnodes/SoVRMLTextureTransform.h>
#include <Inventor/fields/SoSFNode.h>
#include <Inventor/misc/SoProtoInstance.h>

namespace dspace {

namespace {

constexpr int MaximumProtoChain = 256;

struct Texture {
  std::shared_ptr<const Image> image;
  bool repeat = true;
};

Texture ReadTexture(VrmlBuilder& builder, const VrmlFile& file,
                    const SoVRMLAppearance& appearance) {
  Texture texture;
  // The guard's stand-in for ImageTexture.
  if (const auto* url = NodeIn<SoVRMLMovieTexture>(appearance.texture)) {
    texture.image = builder.Texture(file, ToVector(url->url));
    texture.repeat = url->repeatS.getValue() && url->repeatT.getValue();
  } else if (const auto* pixels = NodeIn<SoVRMLPixelTexture>(appearance.texture)) {
    texture.image = ToImage(pixels->image, file.path + "#" + file.NameOf(pixels));
    texture.repeat = pixels->repeatS.getValue() && pixels->repeatT.getValue();
  }
  return texture;
}

// VRML97 4.14: without a Material a shape is unlit and white; vertex colours replace the diffuse
// colour; a texture with colours of its own replaces both.
Material MakeMaterial(const SoVRMLMaterial* source, const Texture& texture, bool colored,
                      bool filled) {
  Material material;
  material.texture = texture.image;
  material.repeatTexture = texture.repeat;
  const bool white = !source || colored || (texture.image && texture.image->channels >= 3);
  if (!source) {
    material.lit = false;
    material.color = {1.0, 1.0, 1.0};
    return material;
  }
  const std::array<double, 3> emissive = ToColor(source->emissiveColor.getValue());
  material.opacity = 1.0 - std::min(1.0f, std::max(0.0f, source->transparency.getValue()));
  material.roughness = RoughnessOf(source->shininess.getValue());
  if (filled) {
    material.color = ToColor(source->diffuseColor.getValue());
    material.emissive = emissive;
  } else {
    material.lit = false; // lines and points shine in the emissive colour
    material.color = emissive;
  }
  if (white) {
    material.color = {1.0, 1.0, 1.0};
  }
  return material;
}

// VRML97 6.49: Tc' = -C * S * R * C * T * Tc.
void TransformTcoords(const SoVRMLTextureTransform& t, Mesh& mesh) {
  const Eigen::Vector2d center = ToEigen(t.center.getValue());
  const Eigen::Affine2d m = Eigen::Translation2d(-center) *
                            Eigen::Scaling(ToEigen(t.scale.getValue())) *
                            Eigen::Rotation2Dd(t.rotation.getValue()) *
                            Eigen::Translation2d(center + ToEigen(t.translation.getValue()));
  for (std::size_t i = 0; i + 1 < mesh.tcoords.size(); i += 2) {
    const Eigen::Vector2d p = m * Eigen::Vector2d(mesh.tcoords[i], mesh.tcoords[i + 1]);
    mesh.tcoords[i] = static_cast<float>(p.x());
    mesh.tcoords[i + 1] = static_cast<float>(p.y());
  }
}

std::uintptr_t Address(const void* p) {
  return reinterpret_cast<std::uintptr_t>(p);
}

} // namespace

SoNode* ResolveProto(SoNode* node) {
  for (int i = 0; node && node->isOfType(SoProtoInstance::getClassTypeId()); ++i) {
    node = i < MaximumProtoChain ? static_cast<SoProtoInstance*>(node)->getRootNode() : nullptr;
  }
  return node;
}

void AddVrml2Shape(VrmlBuilder& builder, const VrmlFile& file, SoVRMLShape* shape, int node) {
  const VrmlBuilder::Key key = {Address(shape)};
  SoNode* geometryNode = ResolveProto(shape->geometry.getValue());
  if (!geometryNode || builder.UseMesh(node, key)) {
    return;
  }
  const auto* appearance = NodeIn<SoVRMLAppearance>(shape->appearance);
  const Texture texture = appearance ? ReadTexture(builder, file, *appearance) : Texture();
  Vrml2Geometry geometry = MakeVrml2Geometry(geometryNode, texture.image != nullptr);
  Mesh& mesh = geometry.mesh;
  mesh.name = file.NameOf(shape);
  if (mesh.name.empty()) {
    mesh.name = file.NameOf(geometryNode);
  }
  builder.WarnShape(file, mesh.name.empty() ? "a shape" : "shape '" + mesh.name + "'",
                    geometry.complaints);

  if (texture.image && texture.image->channels >= 3) {
    mesh.colors.clear();
  }
  const auto* transform =
      appearance ? NodeIn<SoVRMLTextureTransform>(appearance->textureTransform) : nullptr;
  if (transform) {
    TransformTcoords(*transform, mesh);
  }

  const bool filled = mesh.primitive == Mesh::Primitive::Triangles;
  const bool colored = !mesh.colors.empty();
  const VrmlBuilder::Key materialKey = {Address(appearance), geometry.solid, colored, filled};
  mesh.material = builder.FindMaterial(materialKey);
  if (mesh.material < 0 && !mesh.indices.empty()) {
    const auto* source = appearance ? NodeIn<SoVRMLMaterial>(appearance->material) : nullptr;
    Material material = MakeMaterial(source, texture, colored, filled);
    material.doubleSided = !geometry.solid || !filled;
    material.name = source ? file.NameOf(source) : "";
    if (material.name.empty() && appearance) {
      material.name = file.NameOf(appearance);
    }
    mesh.material = builder.AddMaterial(materialKey, material);
  }
  builder.AddMesh(node, key, std::move(mesh));
}

} // namespace dspace
