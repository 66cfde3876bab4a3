#include <dspace/import/vrml/Vrml2Geometry.h>

#include <dspace/import/vrml/Vrml2Shape.h>
#include <dspace/import/vrml/VrmlExtrusion.h>
#include <dspace/import/vrml/VrmlFields.h>
#include <dspace/import/vrml/VrmlLetters.h>
#include <dspace/import/vrml/VrmlSolids.h>

#include <Inventor/VRMLnodes/SoVRMLBox.h>
#include <Inventor/VRMLnodes/SoVRMLColor.h>
#include <Inventor/VRMLnodes/SoVRMLCone.h>
#include <Inventor/VRMLnodes/SoVRMLCoordinate.h>
#include <Inventor/VRMLnodes/SoVRMLCylinder.h>
#include <Inventor/VRMLnodes/SoVRMLElevationGrid.h>
#include <Inventor/VRMLnodes/SoVRMLExtrusion.h>
#include <Inventor/VRMLnodes/SoVRMLFontStyle.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedFaceSet.h>
#include <Inventor/VRMLnodes/SoVRMLIndexedLineSet.h>
#include <Inventor/VRMLnodes/SoVRMLNormal.h>
#include <Inventor/VRMLnodes/SoVRMLPointSet.h>
#include <Inventor/VRMLnodes/SoVRMLSphere.h>
#include <Inventor/VRMLnodes/SoVRMLText.h>
#include <Inventor/VRMLnodes/SoVRMLTextureCoordinate.h>
#include <Inventor/fields/SoSFNode.h>

namespace dspace {

namespace {

VrmlBinding Binding(bool perVertex, bool indexed) {
  return perVertex ? VrmlBinding::PerCornerIndexed
                   : (indexed ? VrmlBinding::PerFaceIndexed : VrmlBinding::PerFace);
}

void ReadPoints(const SoSFNode& field, VrmlFaces& faces) {
  if (const auto* coord = NodeIn<SoVRMLCoordinate>(field)) {
    faces.points = ToVector(coord->point);
  }
}

void ReadColors(const SoSFNode& field, bool perVertex, const std::vector<int>& indices,
                VrmlFaces& faces) {
  if (const auto* color = NodeIn<SoVRMLColor>(field)) {
    faces.colors = {Binding(perVertex, !indices.empty()), ToVector(color->color), indices};
  }
}

void ReadNormals(const SoSFNode& field, bool perVertex, const std::vector<int>& indices,
                 VrmlFaces& faces) {
  if (const auto* normal = NodeIn<SoVRMLNormal>(field)) {
    faces.normals = {Binding(perVertex, !indices.empty()), ToVector(normal->vector), indices};
  }
}

void ReadTcoords(const SoSFNode& field, const std::vector<int>& indices, VrmlFaces& faces) {
  if (const auto* tcoord = NodeIn<SoVRMLTextureCoordinate>(field)) {
    faces.tcoords = {VrmlBinding::PerCornerIndexed, ToVector(tcoord->point), indices};
  }
}

void FromFaceSet(SoVRMLIndexedFaceSet& node, bool textured, Vrml2Geometry& out) {
  VrmlFaces faces;
  ReadPoints(node.coord, faces);
  faces.coordIndex = ToVector(node.coordIndex);
  ReadColors(node.color, node.colorPerVertex.getValue(), ToVector(node.colorIndex), faces);
  ReadNormals(node.normal, node.normalPerVertex.getValue(), ToVector(node.normalIndex), faces);
  ReadTcoords(node.texCoord, ToVector(node.texCoordIndex), faces);
  faces.ccw = node.ccw.getValue();
  faces.convex = node.convex.getValue();
  faces.creaseAngle = node.creaseAngle.getValue();
  faces.defaultTcoords = textured;
  out.solid = node.solid.getValue();
  out.mesh = MakeVrmlFaces(faces, out.complaints);
}

void FromElevationGrid(SoVRMLElevationGrid& node, Vrml2Geometry& out) {
  VrmlElevationGrid grid;
  grid.xDimension = node.xDimension.getValue();
  grid.zDimension = node.zDimension.getValue();
  grid.xSpacing = node.xSpacing.getValue();
  grid.zSpacing = node.zSpacing.getValue();
  const int heights = node.height.getNum();
  if (heights > 0) {
    grid.heights.assign(node.height.getValues(0), node.height.getValues(0) + heights);
  }
  VrmlFaces faces;
  if (!MakeVrmlElevationGrid(grid, faces, out.complaints)) {
    return;
  }
  ReadColors(node.color, node.colorPerVertex.getValue(), {}, faces);
  ReadNormals(node.normal, node.normalPerVertex.getValue(), {}, faces);
  ReadTcoords(node.texCoord, {}, faces);
  faces.ccw = node.ccw.getValue();
  faces.creaseAngle = node.creaseAngle.getValue();
  out.solid = node.solid.getValue();
  out.mesh = MakeVrmlFaces(faces, out.complaints);
}

void FromExtrusion(SoVRMLExtrusion& node, Vrml2Geometry& out) {
  VrmlExtrusion extrusion;
  for (int i = 0; i < node.crossSection.getNum(); ++i) {
    extrusion.crossSection.push_back(ToEigen(node.crossSection[i]));
  }
  for (int i = 0; i < node.spine.getNum(); ++i) {
    extrusion.spine.push_back(ToEigen(node.spine[i]));
  }
  for (int i = 0; i < node.scale.getNum(); ++i) {
    extrusion.scale.push_back(ToEigen(node.scale[i]));
  }
  for (int i = 0; i < node.orientation.getNum(); ++i) {
    extrusion.orientation.push_back(ToEigen(node.orientation[i]));
  }
  extrusion.beginCap = node.beginCap.getValue();
  extrusion.endCap = node.endCap.getValue();
  VrmlFaces faces;
  if (!MakeVrmlExtrusion(extrusion, faces, out.complaints)) {
    return;
  }
  faces.ccw = node.ccw.getValue();
  faces.convex = node.convex.getValue();
  faces.creaseAngle = node.creaseAngle.getValue();
  out.solid = node.solid.getValue();
  out.mesh = MakeVrmlFaces(faces, out.complaints);
}

void FromLineSet(SoVRMLIndexedLineSet& node, Vrml2Geometry& out) {
  VrmlFaces lines;
  ReadPoints(node.coord, lines);
  lines.coordIndex = ToVector(node.coordIndex);
  ReadColors(node.color, node.colorPerVertex.getValue(), ToVector(node.colorIndex), lines);
  out.mesh = MakeVrmlLines(lines, out.complaints);
}

void FromPointSet(SoVRMLPointSet& node, Vrml2Geometry& out) {
  VrmlFaces points;
  ReadPoints(node.coord, points);
  ReadColors(node.color, true, {}, points);
  out.mesh = MakeVrmlPoints(points, out.complaints);
}

void FromText(SoVRMLText& node, Vrml2Geometry& out) {
  VrmlLetters letters;
  letters.lines = ToVector(node.string);
  for (int i = 0; i < node.length.getNum(); ++i) {
    letters.lengths.push_back(node.length[i]);
  }
  letters.maximumExtent = node.maxExtent.getValue();
  if (const auto* style = NodeIn<SoVRMLFontStyle>(node.fontStyle)) {
    letters.size = style->size.getValue();
    letters.spacing = style->spacing.getValue();
    const std::vector<std::string> justify = ToVector(style->justify);
    letters.major = VrmlJustify(justify.empty() ? "" : justify[0], VrmlLetters::Justify::Begin);
    letters.minor = VrmlJustify(justify.size() < 2 ? "" : justify[1], VrmlLetters::Justify::First);
    if (!style->horizontal.getValue() || !style->leftToRight.getValue() ||
        !style->topToBottom.getValue()) {
      out.complaints.emplace_back("text of another direction is written from left to right");
    }
  }
  out.mesh = MakeVrmlLetters(letters, out.complaints);
  out.solid = false; // it is seen from both sides
}

bool Positive(std::initializer_list<double> sizes, Vrml2Geometry& out) {
  for (const double size : sizes) {
    if (!(size > 0.0)) {
      out.complaints.push_back("a size of " + std::to_string(size) + " is not positive: left out");
      return false;
    }
  }
  return true;
}

} // namespace

Vrml2Geometry MakeVrml2Geometry(SoNode* node, bool textured) {
  Vrml2Geometry out;
  const SoType type = node->getTypeId();
  if (type == SoVRMLIndexedFaceSet::getClassTypeId()) {
    FromFaceSet(*static_cast<SoVRMLIndexedFaceSet*>(node), textured, out);
  } else if (type == SoVRMLIndexedLineSet::getClassTypeId()) {
    FromLineSet(*static_cast<SoVRMLIndexedLineSet*>(node), out);
  } else if (type == SoVRMLPointSet::getClassTypeId()) {
    FromPointSet(*static_cast<SoVRMLPointSet*>(node), out);
  } else if (type == SoVRMLElevationGrid::getClassTypeId()) {
    FromElevationGrid(*static_cast<SoVRMLElevationGrid*>(node), out);
  } else if (type == SoVRMLExtrusion::getClassTypeId()) {
    FromExtrusion(*static_cast<SoVRMLExtrusion*>(node), out);
  } else if (type == SoVRMLText::getClassTypeId()) {
    FromText(*static_cast<SoVRMLText*>(node), out);
  } else if (type == SoVRMLBox::getClassTypeId()) {
    const Eigen::Vector3d size = ToEigen(static_cast<SoVRMLBox*>(node)->size.getValue());
    if (Positive({size.x(), size.y(), size.z()}, out)) {
      out.mesh = MakeVrmlBox(size);
    }
  } else if (type == SoVRMLSphere::getClassTypeId()) {
    const double radius = static_cast<SoVRMLSphere*>(node)->radius.getValue();
    if (Positive({radius}, out)) {
      out.mesh = MakeVrmlSphere(radius);
    }
  } else if (type == SoVRMLCylinder::getClassTypeId()) {
    const auto& c = *static_cast<SoVRMLCylinder*>(node);
    if (Positive({c.radius.getValue(), c.height.getValue()}, out)) {
      out.mesh = MakeVrmlCylinder(c.radius.getValue(), c.height.getValue(), c.side.getValue(),
                                  c.top.getValue(), c.bottom.getValue());
    }
  } else if (type == SoVRMLCone::getClassTypeId()) {
    const auto& c = *static_cast<SoVRMLCone*>(node);
    if (Positive({c.bottomRadius.getValue(), c.height.getValue()}, out)) {
      out.mesh = MakeVrmlCone(c.bottomRadius.getValue(), c.height.getValue(), c.side.getValue(),
                              c.bottom.getValue());
    }
  } else {
    out.complaints.push_back("a " + std::string(type.getName().getString()) +
                             " is not a geometry: left out");
  }
  return out;
}

} // namespace dspace
