// The walk over a VRML 2.0 file: transforms to nodes, shapes to meshes.
#include <dspace/import/vrml/Vrml2Walk.h>

#include <dspace/import/vrml/Vrml2Shape.h>
#include <dspace/import/vrml/VrmlFields.h>

#include <algorithm>
#include <limits>

#include <Inventor/VRMLnodes/SoVRMLCollision.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/VRMLnodes/SoVRMLLOD.h>
#include <Inventor/VRMLnodes/SoVRMLParent.h>
#include <Inventor/VRMLnodes/SoVRMLShape.h>
#include <Inventor/VRMLnodes/SoVRMLSwitch.h>
#include <Inventor/VRMLnodes/SoVRMLTransform.h>
#include <Inventor/nodes/SoSeparator.h>

namespace dspace {

namespace {

class Vrml2Walker {
public:
  Vrml2Walker(VrmlBuilder& builder, const VrmlFile& file) : Builder_(builder), File_(file) {}

  void Visit(SoNode* raw, int parent, int depth) {
    this->Builder_.Step(this->File_, depth);
    SoNode* node = ResolveProto(raw);
    if (!node) {
      return;
    }
    const SoType type = node->getTypeId();
    if (node->isOfType(SoVRMLShape::getClassTypeId())) {
      AddVrml2Shape(this->Builder_, this->File_, static_cast<SoVRMLShape*>(node), parent);
    } else if (node->isOfType(SoVRMLTransform::getClassTypeId())) {
      const auto& t = *static_cast<SoVRMLTransform*>(node);
      const int own = this->Builder_.AddNode(
          parent, this->File_.NameOf(node),
          VrmlTransform(t.translation.getValue(), t.center.getValue(), t.rotation.getValue(),
                        t.scale.getValue(), t.scaleOrientation.getValue()));
      this->VisitAll(t.children, own, depth);
    } else if (type == SoVRMLSwitch::getClassTypeId()) {
      const auto& s = *static_cast<SoVRMLSwitch*>(node);
      this->VisitOne(s.choice, s.whichChoice.getValue(), this->Named(node, parent), depth);
    } else if (type == SoVRMLLOD::getClassTypeId()) {
      this->VisitLevels(*static_cast<SoVRMLLOD*>(node), this->Named(node, parent), depth);
    } else if (type == SoVRMLInline::getClassTypeId()) {
      this->Builder_.Inline(this->File_, ToVector(static_cast<SoVRMLInline*>(node)->url),
                            this->Named(node, parent), depth);
    } else if (node->isOfType(SoVRMLParent::getClassTypeId())) {
      this->VisitAll(static_cast<SoVRMLParent*>(node)->children, this->Named(node, parent), depth);
    } else if (node->isOfType(SoGroup::getClassTypeId())) {
      const auto& group = *static_cast<SoGroup*>(node);
      for (int i = 0; i < group.getNumChildren(); ++i) {
        this->Visit(group.getChild(i), parent, depth + 1);
      }
    }
  }

private:
  // A grouping node moves nothing: it becomes a node only where DEF gives it a name.
  int Named(const SoNode* node, int parent) {
    const std::string name = this->File_.NameOf(node);
    return name.empty() ? parent
                        : this->Builder_.AddNode(parent, name, Eigen::Affine3d::Identity());
  }

  void VisitAll(const SoMFNode& children, int parent, int depth) {
    for (int i = 0; i < children.getNum(); ++i) {
      this->Visit(children[i], parent, depth + 1);
    }
  }

  void VisitOne(const SoMFNode& children, int which, int parent, int depth) {
    if (which >= 0 && which < children.getNum()) {
      this->Visit(children[which], parent, depth + 1);
    }
  }

  // VRML97 6.26: level i is shown from range[i - 1] to range[i]; further ranges show the last
  // level. Without ranges the browser is free: the first level, which is the finest.
  void VisitLevels(const SoVRMLLOD& lod, int parent, int depth) {
    const int levels = lod.level.getNum();
    const int ranges = lod.range.getNum();
    if (ranges == 0) {
      this->VisitOne(lod.level, 0, parent, depth);
      return;
    }
    DistanceRange range;
    range.center = ToEigen(lod.center.getValue());
    for (int i = 0; i < levels && i <= ranges; ++i) {
      range.from = i == 0 ? 0.0 : range.to;
      range.to = i + 1 < levels && i < ranges ? std::max<double>(lod.range[i], range.from)
                                              : std::numeric_limits<double>::infinity();
      const int own = this->Builder_.AddNode(parent, "", Eigen::Affine3d::Identity());
      this->Builder_.SetRange(own, range);
      this->Visit(lod.level[i], own, depth + 1);
    }
  }

  VrmlBuilder& Builder_;
  const VrmlFile& File_;
};

} // namespace

void WalkVrml2(VrmlBuilder& builder, const VrmlFile& file, int parent, int depth) {
  Vrml2Walker(builder, file).Visit(file.root.get(), parent, depth);
}

} // namespace dspace
