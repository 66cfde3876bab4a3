#include <dspace/import/vrml/Vrml1Shape.h>

#include <dspace/import/vrml/VrmlFields.h>
#include <dspace/import/vrml/VrmlLetters.h>
#include <dspace/import/vrml/VrmlSolids.h>

#include <Inventor/nodes/SoNodes.h>

#include <algorithm>

namespace dspace {

namespace {

template<typename Node> Node* As(SoNode* node) {
  return node && node->isOfType(Node::getClassTypeId()) ? static_cast<Node*>(node) : nullptr;
}

bool IsDefaultIndex(const std::vector<int>& indices) {
  return indices.empty() || (indices.size() == 1 && indices[0] == -1);
}

// Both bindings number their values alike (SoMaterialBinding, SoNormalBinding).
VrmlBinding BindingOf(int value, const std::vector<int>& indices) {
  switch (value) {
  case SoMaterialBinding::PER_PART:
  case SoMaterialBinding::PER_FACE:
    return VrmlBinding::PerFace;
  case SoMaterialBinding::PER_PART_INDEXED:
  case SoMaterialBinding::PER_FACE_INDEXED:
    return IsDefaultIndex(indices) ? VrmlBinding::PerFace : VrmlBinding::PerFaceIndexed;
  case SoMaterialBinding::PER_VERTEX:
    return VrmlBinding::PerCorner;
  case SoMaterialBinding::PER_VERTEX_INDEXED:
    return VrmlBinding::PerCornerIndexed;
  default:
    return VrmlBinding::Overall;
  }
}

std::vector<int> OwnIndices(const SoMFInt32& field) {
  std::vector<int> indices = ToVector(field);
  return IsDefaultIndex(indices) ? std::vector<int>() : indices;
}

// Diffuse colours with their opacities, for bindings other than OVERALL.
void ReadColors(const Vrml1State& state, const std::vector<int>& indices, VrmlFaces& faces) {
  const auto* binding = As<SoMaterialBinding>(state.materialBinding);
  const VrmlBinding kind =
      binding ? BindingOf(binding->value.getValue(), indices) : VrmlBinding::Overall;
  if (kind == VrmlBinding::Overall) {
    return;
  }
  if (const auto* material = As<SoMaterial>(state.material)) {
    const SoMFFloat& transparency = material->transparency;
    for (int i = 0; i < material->diffuseColor.getNum(); ++i) {
      const int n = transparency.getNum();
      const double t = n > 0 ? transparency[std::min(i, n - 1)] : 0.0;
      faces.colors.values.push_back(ToBytes(material->diffuseColor[i], 1.0 - t));
    }
  } else if (const auto* base = As<SoBaseColor>(state.material)) {
    faces.colors.values = ToVector(base->rgb);
  }
  if (faces.colors.values.size() > 1) {
    faces.colors.binding = kind;
    faces.colors.indices = indices;
  } else {
    faces.colors.values.clear(); // one colour is the material's own
  }
}

void ReadNormals(const Vrml1State& state, const std::vector<int>& indices, VrmlFaces& faces) {
  const auto* normals = As<SoNormal>(state.normals);
  if (!normals || normals->vector.getNum() == 0) {
    return;
  }
  faces.normals.values = ToVector(normals->vector);
  faces.normals.indices = indices;
  const auto* binding = As<SoNormalBinding>(state.normalBinding);
  faces.normals.binding = binding ? BindingOf(binding->value.getValue(), indices)
                                  : VrmlBinding::PerCornerIndexed; // DEFAULT
  if (binding && binding->value.getValue() == SoMaterialBinding::PER_VERTEX_INDEXED) {
    faces.normals.binding = VrmlBinding::PerCornerIndexed;
  }
}

Mesh FromFaceSet(const SoIndexedFaceSet& node, const Vrml1State& state, bool textured,
                 VrmlComplaints& complaints) {
  VrmlFaces faces;
  if (const auto* coordinates = As<SoCoordinate3>(state.coordinates)) {
    faces.points = ToVector(coordinates->point);
  }
  faces.coordIndex = ToVector(node.coordIndex);
  ReadColors(state, OwnIndices(node.materialIndex), faces);
  ReadNormals(state, OwnIndices(node.normalIndex), faces);
  if (const auto* tcoords = As<SoTextureCoordinate2>(state.textureCoordinates)) {
    faces.tcoords = {VrmlBinding::PerCornerIndexed, ToVector(tcoords->point),
                     OwnIndices(node.textureCoordIndex)};
  }
  faces.defaultTcoords = textured;
  faces.creaseAngle = 0.5; // VRML 1.0's default
  if (const auto* hints = As<SoShapeHints>(state.hints)) {
    faces.ccw = hints->vertexOrdering.getValue() != SoShapeHints::CLOCKWISE;
    faces.convex = hints->faceType.getValue() == SoShapeHints::CONVEX;
    faces.creaseAngle = hints->creaseAngle.getValue();
  }
  return MakeVrmlFaces(faces, complaints);
}

Mesh FromLineSet(const SoIndexedLineSet& node, const Vrml1State& state,
                 VrmlComplaints& complaints) {
  VrmlFaces lines;
  if (const auto* coordinates = As<SoCoordinate3>(state.coordinates)) {
    lines.points = ToVector(coordinates->point);
  }
  lines.coordIndex = ToVector(node.coordIndex);
  ReadColors(state, OwnIndices(node.materialIndex), lines);
  return MakeVrmlLines(lines, complaints);
}

Mesh FromPointSet(const SoPointSet& node, const Vrml1State& state, VrmlComplaints& complaints) {
  VrmlFaces points;
  if (const auto* coordinates = As<SoCoordinate3>(state.coordinates)) {
    points.points = ToVector(coordinates->point);
  }
  const auto available = static_cast<long long>(points.points.size());
  const long long first = std::clamp<long long>(node.startIndex.getValue(), 0, available);
  const long long wanted = node.numPoints.getValue();
  const long long count = wanted < 0 ? available - first : std::min(wanted, available - first);
  if (wanted > count) {
    complaints.push_back(std::to_string(wanted) + " points of " + std::to_string(available) +
                         " are asked for");
  }
  ReadColors(state, {}, points);
  points.points = {points.points.begin() + first, points.points.begin() + first + count};
  return MakeVrmlPoints(points, complaints);
}

Mesh FromText(const SoAsciiText& node, const Vrml1State& state, VrmlComplaints& complaints) {
  VrmlLetters letters;
  letters.lines = ToVector(node.string);
  letters.size = 10.0; // VRML 1.0's default
  if (const auto* style = As<SoFontStyle>(state.fontStyle)) {
    letters.size = style->size.getValue();
  }
  letters.spacing = node.spacing.getValue();
  const int side = node.justification.getValue();
  letters.major = side == SoAsciiText::CENTER  ? VrmlLetters::Justify::Middle
                  : side == SoAsciiText::RIGHT ? VrmlLetters::Justify::End
                                               : VrmlLetters::Justify::Begin;
  for (int i = 0; i < node.width.getNum(); ++i) {
    letters.lengths.push_back(node.width[i]);
  }
  return MakeVrmlLetters(letters, complaints);
}

bool Positive(std::initializer_list<double> sizes, VrmlComplaints& complaints) {
  const bool positive = std::all_of(sizes.begin(), sizes.end(), [](double s) { return s > 0.0; });
  if (!positive) {
    complaints.push_back("a size that is not positive: left out");
  }
  return positive;
}

Mesh MakeShape(SoNode* shape, const Vrml1State& state, bool textured, VrmlComplaints& complaints) {
  if (const auto* faces = As<SoIndexedFaceSet>(shape)) {
    return FromFaceSet(*faces, state, textured, complaints);
  }
  if (const auto* lines = As<SoIndexedLineSet>(shape)) {
    return FromLineSet(*lines, state, complaints);
  }
  if (const auto* points = As<SoPointSet>(shape)) {
    return FromPointSet(*points, state, complaints);
  }
  if (const auto* text = As<SoAsciiText>(shape)) {
    return FromText(*text, state, complaints);
  }
  if (const auto* cube = As<SoCube>(shape)) {
    const Eigen::Vector3d size(cube->width.getValue(), cube->height.getValue(),
                               cube->depth.getValue());
    return Positive({size.x(), size.y(), size.z()}, complaints) ? MakeVrmlBox(size) : Mesh();
  }
  if (const auto* sphere = As<SoSphere>(shape)) {
    const double radius = sphere->radius.getValue();
    return Positive({radius}, complaints) ? MakeVrmlSphere(radius) : Mesh();
  }
  if (const auto* c = As<SoCylinder>(shape)) {
    const int parts = c->parts.getValue();
    return Positive({c->radius.getValue(), c->height.getValue()}, complaints)
               ? MakeVrmlCylinder(c->radius.getValue(), c->height.getValue(),
                                  (parts & SoCylinder::SIDES) != 0, (parts & SoCylinder::TOP) != 0,
                                  (parts & SoCylinder::BOTTOM) != 0)
               : Mesh();
  }
  if (const auto* c = As<SoCone>(shape)) {
    const int parts = c->parts.getValue();
    return Positive({c->bottomRadius.getValue(), c->height.getValue()}, complaints)
               ? MakeVrmlCone(c->bottomRadius.getValue(), c->height.getValue(),
                              (parts & SoCone::SIDES) != 0, (parts & SoCone::BOTTOM) != 0)
               : Mesh();
  }
  complaints.push_back("a " + std::string(shape->getTypeId().getName().getString()) +
                       " is not read");
  return {};
}

// Inventor's order: about its centre a texture is scaled, then turned, then moved.
void TransformTcoords(const SoTexture2Transform& t, Mesh& mesh) {
  const Eigen::Vector2d center = ToEigen(t.center.getValue());
  const Eigen::Affine2d m = Eigen::Translation2d(ToEigen(t.translation.getValue()) + center) *
                            Eigen::Rotation2Dd(t.rotation.getValue()) *
                            Eigen::Scaling(ToEigen(t.scaleFactor.getValue())) *
                            Eigen::Translation2d(-center);
  for (std::size_t i = 0; i + 1 < mesh.tcoords.size(); i += 2) {
    const Eigen::Vector2d p = m * Eigen::Vector2d(mesh.tcoords[i], mesh.tcoords[i + 1]);
    mesh.tcoords[i] = static_cast<float>(p.x());
    mesh.tcoords[i + 1] = static_cast<float>(p.y());
  }
}

std::shared_ptr<const Image> ReadTexture(VrmlBuilder& builder, const VrmlFile& file,
                                         const SoTexture2* texture) {
  if (!texture) {
    return nullptr;
  }
  const auto name = file.guarded.textures.find(texture->getName().getString());
  if (name != file.guarded.textures.end()) {
    return name->second.empty() ? nullptr : builder.Texture(file, {name->second});
  }
  return ToImage(texture->image, file.path + "#" + file.NameOf(texture));
}

Material MakeMaterial(const Vrml1State& state, bool colored, bool filled) {
  Material result;
  if (const auto* material = As<SoMaterial>(state.material)) {
    if (material->diffuseColor.getNum() > 0) {
      result.color = ToColor(material->diffuseColor[0]);
    }
    if (material->emissiveColor.getNum() > 0) {
      result.emissive = ToColor(material->emissiveColor[0]);
    }
    if (material->shininess.getNum() > 0) {
      result.roughness = RoughnessOf(material->shininess[0]);
    }
    if (material->transparency.getNum() > 0 && !colored) {
      result.opacity = 1.0 - std::clamp<double>(material->transparency[0], 0.0, 1.0);
    }
  } else if (const auto* base = As<SoBaseColor>(state.material)) {
    if (base->rgb.getNum() > 0) {
      result.color = ToColor(base->rgb[0]);
    }
  }
  if (colored) {
    result.color = {1.0, 1.0, 1.0};
  }
  result.lit = filled;
  const auto* hints = As<SoShapeHints>(state.hints);
  result.doubleSided = !filled || !hints || hints->shapeType.getValue() != SoShapeHints::SOLID ||
                       hints->vertexOrdering.getValue() == SoShapeHints::UNKNOWN_ORDERING;
  return result;
}

// VRML 1.0 is drawn as OpenGL 1 does: a texture multiplies the sum of emission and reflection.
// Material adds the emission after it, so that white would hide the texture.
void DimEmission(const Image& texture, Material& material) {
  const double least = *std::min_element(material.emissive.begin(), material.emissive.end());
  if (least >= 0.999) { // reflection adds nothing to white: the texture as it is
    material.emissive = {0.0, 0.0, 0.0};
    material.color = {1.0, 1.0, 1.0};
    material.lit = false;
    return;
  }
  std::array<double, 3> sum = {0.0, 0.0, 0.0};
  const std::size_t n = static_cast<std::size_t>(texture.channels);
  for (std::size_t p = 0; p + n <= texture.pixels.size(); p += n) {
    for (std::size_t c = 0; c < 3; ++c) {
      sum[c] += texture.pixels[p + (n >= 3 ? c : 0)];
    }
  }
  const double pixels = static_cast<double>(texture.pixels.size() / n);
  for (std::size_t c = 0; c < 3; ++c) {
    material.emissive[c] *= sum[c] / (255.0 * pixels);
  }
}

} // namespace

bool Vrml1State::SetProperty(SoNode* candidate) {
  const SoType type = candidate->getTypeId();
  const std::pair<SoType, SoNode**> kinds[] = {
      {SoCoordinate3::getClassTypeId(), &this->coordinates},
      {SoNormal::getClassTypeId(), &this->normals},
      {SoNormalBinding::getClassTypeId(), &this->normalBinding},
      {SoMaterial::getClassTypeId(), &this->material},
      {SoBaseColor::getClassTypeId(), &this->material},
      {SoMaterialBinding::getClassTypeId(), &this->materialBinding},
      {SoTexture2::getClassTypeId(), &this->texture},
      {SoTexture2Transform::getClassTypeId(), &this->textureTransform},
      {SoTextureCoordinate2::getClassTypeId(), &this->textureCoordinates},
      {SoShapeHints::getClassTypeId(), &this->hints},
      {SoFontStyle::getClassTypeId(), &this->fontStyle}};
  for (const auto& [kind, slot] : kinds) {
    if (type == kind) {
      *slot = candidate;
      return true;
    }
  }
  return false;
}

void AddVrml1Shape(VrmlBuilder& builder, const VrmlFile& file, SoNode* shape,
                   const Vrml1State& state, int node) {
  VrmlBuilder::Key key;
  for (const SoNode* part :
       {static_cast<const SoNode*>(shape), static_cast<const SoNode*>(state.coordinates),
        static_cast<const SoNode*>(state.normals), static_cast<const SoNode*>(state.normalBinding),
        static_cast<const SoNode*>(state.material),
        static_cast<const SoNode*>(state.materialBinding),
        static_cast<const SoNode*>(state.texture),
        static_cast<const SoNode*>(state.textureTransform),
        static_cast<const SoNode*>(state.textureCoordinates),
        static_cast<const SoNode*>(state.hints), static_cast<const SoNode*>(state.fontStyle)}) {
    key.push_back(reinterpret_cast<std::uintptr_t>(part));
  }
  if (builder.UseMesh(node, key)) {
    return;
  }
  const auto* texture = As<SoTexture2>(state.texture);
  const std::shared_ptr<const Image> image = ReadTexture(builder, file, texture);
  VrmlComplaints complaints;
  Mesh mesh = MakeShape(shape, state, image != nullptr, complaints);
  mesh.name = file.NameOf(shape);
  builder.WarnShape(file, mesh.name.empty() ? "a shape" : "shape '" + mesh.name + "'", complaints);
  if (const auto* transform = As<SoTexture2Transform>(state.textureTransform)) {
    TransformTcoords(*transform, mesh);
  }
  if (!mesh.indices.empty()) {
    const bool filled = mesh.primitive == Mesh::Primitive::Triangles;
    const bool colored = !mesh.colors.empty();
    const VrmlBuilder::Key materialKey = {key[4], key[6], key[9], colored, filled, 1};
    mesh.material = builder.FindMaterial(materialKey);
    if (mesh.material < 0) {
      Material material = MakeMaterial(state, colored, filled);
      material.name = state.material ? file.NameOf(state.material) : "";
      material.texture = image;
      if (image && filled) {
        DimEmission(*image, material);
      }
      material.repeatTexture = !texture || (texture->wrapS.getValue() == SoTexture2::REPEAT &&
                                            texture->wrapT.getValue() == SoTexture2::REPEAT);
      mesh.material = builder.AddMaterial(materialKey, material);
    }
  }
  builder.AddMesh(node, key, std::move(mesh));
}

} // namespace dspace
