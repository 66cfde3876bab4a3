#include <dspace/import/vrml/text/VrmlNodeTable.h>

#include <sstream>

namespace dspace {

namespace {

using Table = std::unordered_map<std::string, VrmlNodeType>;

// One line a node: its name, then its fields with their types. A leading '-' marks a field that is
// checked but of no use here; '+' a VRML 1.0 node with children.
const char* const Vrml2Nodes = R"(
Anchor children=MFNode -description=SFString -parameter=MFString -url=MFString -bboxCenter=SFVec3f -bboxSize=SFVec3f
Billboard children=MFNode -axisOfRotation=SFVec3f -bboxCenter=SFVec3f -bboxSize=SFVec3f
Collision children=MFNode proxy=SFNode -collide=SFBool -bboxCenter=SFVec3f -bboxSize=SFVec3f
Group children=MFNode -bboxCenter=SFVec3f -bboxSize=SFVec3f
Transform children=MFNode center=SFVec3f rotation=SFRotation scale=SFVec3f scaleOrientation=SFRotation translation=SFVec3f -bboxCenter=SFVec3f -bboxSize=SFVec3f
Switch choice=MFNode whichChoice=SFInt32
LOD level=MFNode center=SFVec3f range=MFFloat
Inline url=MFString -bboxCenter=SFVec3f -bboxSize=SFVec3f
Shape appearance=SFNode geometry=SFNode
Appearance material=SFNode texture=SFNode textureTransform=SFNode
Material ambientIntensity=SFFloat diffuseColor=SFColor emissiveColor=SFColor shininess=SFFloat specularColor=SFColor transparency=SFFloat
ImageTexture url=MFString repeatS=SFBool repeatT=SFBool
PixelTexture image=SFImage repeatS=SFBool repeatT=SFBool
TextureTransform center=SFVec2f rotation=SFFloat scale=SFVec2f translation=SFVec2f
Box size=SFVec3f
Sphere radius=SFFloat
Cylinder bottom=SFBool height=SFFloat radius=SFFloat side=SFBool top=SFBool
Cone bottom=SFBool bottomRadius=SFFloat height=SFFloat side=SFBool
IndexedFaceSet ccw=SFBool color=SFNode colorIndex=MFInt32 colorPerVertex=SFBool convex=SFBool coord=SFNode coordIndex=MFInt32 creaseAngle=SFFloat normal=SFNode normalIndex=MFInt32 normalPerVertex=SFBool solid=SFBool texCoord=SFNode texCoordIndex=MFInt32
IndexedLineSet color=SFNode colorIndex=MFInt32 colorPerVertex=SFBool coord=SFNode coordIndex=MFInt32
PointSet color=SFNode coord=SFNode
ElevationGrid ccw=SFBool color=SFNode colorPerVertex=SFBool creaseAngle=SFFloat height=MFFloat normal=SFNode normalPerVertex=SFBool solid=SFBool texCoord=SFNode xDimension=SFInt32 xSpacing=SFFloat zDimension=SFInt32 zSpacing=SFFloat
Extrusion beginCap=SFBool ccw=SFBool convex=SFBool creaseAngle=SFFloat crossSection=MFVec2f endCap=SFBool orientation=MFRotation scale=MFVec2f solid=SFBool spine=MFVec3f
Coordinate point=MFVec3f
Normal vector=MFVec3f
Color color=MFColor
TextureCoordinate point=MFVec2f
Text string=MFString fontStyle=SFNode length=MFFloat maxExtent=SFFloat
FontStyle -family=MFString horizontal=SFBool justify=MFString -language=SFString leftToRight=SFBool size=SFFloat spacing=SFFloat -style=SFString topToBottom=SFBool
)";
const char* const Vrml2Ignored = "NavigationInfo WorldInfo";
const char* const Vrml2Listed =
    "AudioClip Background ColorInterpolator CoordinateInterpolator CylinderSensor DirectionalLight "
    "Fog NormalInterpolator OrientationInterpolator PlaneSensor PointLight PositionInterpolator "
    "ProximitySensor ScalarInterpolator Script Sound SphereSensor SpotLight TimeSensor TouchSensor "
    "Viewpoint VisibilitySensor";
const char* const Vrml2Unsupported = "MovieTexture";

const char* const Vrml1Nodes = R"(
+Separator -renderCulling=SFEnum -renderCaching=SFEnum -boundingBoxCaching=SFEnum -pickCulling=SFEnum
+TransformSeparator
+Annotation
+Group
+Switch whichChild=SFInt32
+LOD range=MFFloat center=SFVec3f
+LevelOfDetail -screenArea=MFFloat
+WWWAnchor -name=SFString -description=SFString -map=SFEnum
WWWInline name=SFString -bboxSize=SFVec3f -bboxCenter=SFVec3f
File name=SFString
Transform translation=SFVec3f rotation=SFRotation scaleFactor=SFVec3f scaleOrientation=SFRotation center=SFVec3f
Translation translation=SFVec3f
Rotation rotation=SFRotation
RotationXYZ axis=SFEnum angle=SFFloat
Scale scaleFactor=SFVec3f
MatrixTransform matrix=SFMatrix
Coordinate3 point=MFVec3f
Normal vector=MFVec3f
NormalBinding value=SFEnum
MaterialBinding value=SFEnum
Material ambientColor=MFColor diffuseColor=MFColor specularColor=MFColor emissiveColor=MFColor shininess=MFFloat transparency=MFFloat
BaseColor rgb=MFColor
Texture2 filename=SFString image=SFImage wrapS=SFEnum wrapT=SFEnum -model=SFEnum -blendColor=SFColor
Texture2Transform translation=SFVec2f rotation=SFFloat scaleFactor=SFVec2f center=SFVec2f
TextureCoordinate2 point=MFVec2f
ShapeHints vertexOrdering=SFEnum shapeType=SFEnum faceType=SFEnum creaseAngle=SFFloat
IndexedFaceSet coordIndex=MFInt32 materialIndex=MFInt32 normalIndex=MFInt32 textureCoordIndex=MFInt32
IndexedLineSet coordIndex=MFInt32 materialIndex=MFInt32 -normalIndex=MFInt32 -textureCoordIndex=MFInt32
PointSet startIndex=SFInt32 numPoints=SFInt32
Cube width=SFFloat height=SFFloat depth=SFFloat
Sphere radius=SFFloat
Cylinder parts=SFEnum radius=SFFloat height=SFFloat
Cone parts=SFEnum bottomRadius=SFFloat height=SFFloat
AsciiText string=MFString spacing=SFFloat justification=SFEnum width=MFFloat
FontStyle size=SFFloat -family=SFEnum -style=SFEnum
Font size=SFFloat -name=SFName
)";
const char* const Vrml1Ignored =
    "Info Label Complexity PickStyle TextureCoordinateBinding NavigationInfo";
const char* const Vrml1Listed = "DirectionalLight PointLight SpotLight OrthographicCamera "
                                "PerspectiveCamera Environment DrawStyle LightModel Viewpoint "
                                "Background";
const char* const Vrml1Unsupported = "Text2 Text3 FaceSet LineSet TriangleStripSet "
                                     "QuadMesh IndexedTriangleStripSet PackedColor VertexProperty "
                                     "Units ResetTransform Array MultipleCopy NurbsSurface";

Table Parse(const char* kept, const char* ignored, const char* listed, const char* unsupported) {
  Table table;
  std::istringstream lines(kept);
  for (std::string line; std::getline(lines, line);) {
    std::istringstream words(line);
    std::string name;
    if (!(words >> name)) {
      continue;
    }
    VrmlNodeType type;
    type.group = name[0] == '+';
    name.erase(0, type.group ? 1 : 0);
    for (std::string word; words >> word;) {
      const bool kept = word[0] != '-';
      const std::size_t equals = word.find('=');
      VrmlFieldType field;
      FindVrmlFieldType(word.substr(equals + 1), field);
      field.kept = kept;
      type.fields[word.substr(kept ? 0 : 1, equals - (kept ? 0 : 1))] = field;
    }
    table[name] = type;
  }
  for (const auto& [names, use] : {std::pair(ignored, VrmlNodeType::Use::Ignored),
                                   std::pair(listed, VrmlNodeType::Use::Listed),
                                   std::pair(unsupported, VrmlNodeType::Use::Unsupported)}) {
    std::istringstream words(names);
    for (std::string name; words >> name;) {
      table[name].use = use;
    }
  }
  return table;
}

} // namespace

bool FindVrmlFieldType(const std::string& name, VrmlFieldType& type) {
  using Base = VrmlFieldType::Base;
  static const std::unordered_map<std::string, std::pair<Base, int>> types = {
      {"Bool", {Base::Boolean, 1}},  {"Color", {Base::Number, 3}},    {"Float", {Base::Number, 1}},
      {"Time", {Base::Number, 1}},   {"Image", {Base::Image, 1}},     {"Int32", {Base::Integer, 1}},
      {"Node", {Base::Node, 1}},     {"Rotation", {Base::Number, 4}}, {"String", {Base::String, 1}},
      {"Vec2f", {Base::Number, 2}},  {"Vec3f", {Base::Number, 3}},    {"Enum", {Base::Enum, 1}},
      {"Matrix", {Base::Number, 16}}};
  const auto found = name.size() > 2 ? types.find(name.substr(2)) : types.end();
  if (found == types.end() || (name.rfind("SF", 0) != 0 && name.rfind("MF", 0) != 0)) {
    return false;
  }
  type.name = name;
  type.base = found->second.first;
  type.arity = found->second.second;
  type.many = name[0] == 'M';
  type.kept = true;
  return true;
}

const VrmlNodeType* FindVrmlNodeType(VrmlDialect dialect, const std::string& name) {
  static const Table vrml1 = Parse(Vrml1Nodes, Vrml1Ignored, Vrml1Listed, Vrml1Unsupported);
  static const Table vrml2 = Parse(Vrml2Nodes, Vrml2Ignored, Vrml2Listed, Vrml2Unsupported);
  const Table& table = dialect == VrmlDialect::Vrml1 ? vrml1 : vrml2;
  const auto found = table.find(name);
  return found == table.end() ? nullptr : &found->second;
}

} // namespace dspace
