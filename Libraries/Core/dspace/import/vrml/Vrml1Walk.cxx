// The walk over a VRML 1.0 or Inventor file: a state that nodes change, and shapes that it draws.
#include <dspace/import/vrml/Vrml1Walk.h>

#include <dspace/import/vrml/Vrml1Shape.h>
#include <dspace/import/vrml/VrmlFields.h>

#include <algorithm>
#include <limits>

#include <Inventor/nodes/SoNodes.h>

namespace dspace {

namespace {

class Vrml1Walker {
public:
  Vrml1Walker(VrmlBuilder& builder, const VrmlFile& file) : Builder_(builder), File_(file) {}

  void Visit(SoNode* node, Vrml1State& state, int depth) {
    this->Builder_.Step(this->File_, depth);
    if (this->ChangesState(node, state)) {
      return;
    }
    if (node->isOfType(SoShape::getClassTypeId())) {
      AddVrml1Shape(this->Builder_, this->File_, node, state, this->NodeFor(state));
    } else if (node->isOfType(SoWWWInline::getClassTypeId())) {
      const std::string name = static_cast<SoWWWInline*>(node)->name.getValue().getString();
      if (!name.empty()) {
        this->Builder_.Inline(this->File_, {name}, this->NodeFor(state), depth);
      }
    } else if (node->isOfType(SoGroup::getClassTypeId())) {
      this->VisitGroup(*static_cast<SoGroup*>(node), state, depth);
    }
  }

private:
  void VisitGroup(SoGroup& group, Vrml1State& state, int depth) {
    const bool separates = group.isOfType(SoSeparator::getClassTypeId()) ||
                           group.isOfType(SoWWWAnchor::getClassTypeId()) ||
                           group.isOfType(SoLOD::getClassTypeId()) ||
                           group.isOfType(SoLevelOfDetail::getClassTypeId());
    const bool separatesTransform = group.isOfType(SoTransformSeparator::getClassTypeId());
    Vrml1State inner = state;
    Vrml1State& used = separates || separatesTransform ? inner : state;
    const std::string name = this->File_.NameOf(&group);
    if (!name.empty() && separates) {
      used.node = this->Builder_.AddNode(this->NodeFor(used), name, Eigen::Affine3d::Identity());
      used.local = Eigen::Affine3d::Identity();
      used.localNode = used.node;
    }
    const int count = group.getNumChildren();
    if (group.isOfType(SoSwitch::getClassTypeId())) {
      const int which = static_cast<SoSwitch&>(group).whichChild.getValue();
      for (int i = 0; i < count; ++i) {
        if (i == which || which == SO_SWITCH_ALL) {
          this->Visit(group.getChild(i), used, depth + 1);
        }
      }
    } else if (group.isOfType(SoLOD::getClassTypeId()) &&
               static_cast<SoLOD&>(group).range.getNum() > 0) {
      this->VisitLevels(static_cast<SoLOD&>(group), used, depth);
    } else if (group.isOfType(SoLOD::getClassTypeId()) ||
               group.isOfType(SoLevelOfDetail::getClassTypeId())) {
      if (count > 0) {
        this->Visit(group.getChild(0), used, depth + 1);
      }
    } else {
      for (int i = 0; i < count; ++i) {
        this->Visit(group.getChild(i), used, depth + 1);
      }
    }
    if (separatesTransform) {
      inner.node = state.node;
      inner.local = state.local;
      inner.localNode = state.localNode;
      state = inner;
    }
  }

  // As in VRML 2.0: level i is shown from range[i - 1] to range[i].
  void VisitLevels(SoLOD& lod, Vrml1State& state, int depth) {
    const int levels = lod.getNumChildren();
    const int ranges = lod.range.getNum();
    DistanceRange range;
    range.center = ToEigen(lod.center.getValue());
    for (int i = 0; i < levels && i <= ranges; ++i) {
      range.from = i == 0 ? 0.0 : range.to;
      range.to = i + 1 < levels && i < ranges ? std::max<double>(lod.range[i], range.from)
                                              : std::numeric_limits<double>::infinity();
      Vrml1State inner = state;
      inner.node = this->Builder_.AddNode(this->NodeFor(state), "", Eigen::Affine3d::Identity());
      inner.local = Eigen::Affine3d::Identity();
      inner.localNode = inner.node;
      this->Builder_.SetRange(inner.node, range);
      this->Visit(lod.getChild(i), inner, depth + 1);
    }
  }

  // The model's node for the transform at this point: one for all shapes that share it.
  int NodeFor(Vrml1State& state) {
    if (state.localNode < 0) {
      state.localNode = this->Builder_.AddNode(state.node, state.transformName, state.local);
    }
    return state.localNode;
  }

  void Append(Vrml1State& state, SoNode* node, const Eigen::Affine3d& m) {
    state.local = state.local * m;
    state.localNode = -1;
    state.transformName = this->File_.NameOf(node);
  }

  // Transforms and properties; false for shapes and groups.
  bool ChangesState(SoNode* node, Vrml1State& state) {
    const SoType type = node->getTypeId();
    const SbVec3f zero(0.0f, 0.0f, 0.0f);
    const SbVec3f one(1.0f, 1.0f, 1.0f);
    const SbRotation none = SbRotation::identity();
    if (type == SoTransform::getClassTypeId()) {
      const auto& t = *static_cast<SoTransform*>(node);
      this->Append(state, node,
                   VrmlTransform(t.translation.getValue(), t.center.getValue(),
                                 t.rotation.getValue(), t.scaleFactor.getValue(),
                                 t.scaleOrientation.getValue()));
    } else if (type == SoTranslation::getClassTypeId()) {
      const SbVec3f t = static_cast<SoTranslation*>(node)->translation.getValue();
      this->Append(state, node, VrmlTransform(t, zero, none, one, none));
    } else if (type == SoRotation::getClassTypeId()) {
      const SbRotation r = static_cast<SoRotation*>(node)->rotation.getValue();
      this->Append(state, node, VrmlTransform(zero, zero, r, one, none));
    } else if (type == SoRotationXYZ::getClassTypeId()) {
      const SbRotation r = static_cast<SoRotationXYZ*>(node)->getRotation();
      this->Append(state, node, VrmlTransform(zero, zero, r, one, none));
    } else if (type == SoScale::getClassTypeId()) {
      const SbVec3f s = static_cast<SoScale*>(node)->scaleFactor.getValue();
      this->Append(state, node, VrmlTransform(zero, zero, none, s, none));
    } else if (type == SoMatrixTransform::getClassTypeId()) {
      // Coin's matrices act on row vectors: each row here is a column of the affine map.
      const SbMatrix m = static_cast<SoMatrixTransform*>(node)->matrix.getValue();
      Eigen::Affine3d a = Eigen::Affine3d::Identity();
      for (int row = 0; row < 4; ++row) {
        a.matrix().col(row).head<3>() = Eigen::Vector3d(m[row][0], m[row][1], m[row][2]);
      }
      this->Append(state, node, a);
    } else {
      return state.SetProperty(node);
    }
    return true;
  }

  VrmlBuilder& Builder_;
  const VrmlFile& File_;
};

} // namespace

void WalkVrml1(VrmlBuilder& builder, const VrmlFile& file, int parent, int depth) {
  Vrml1State state;
  state.node = parent;
  state.localNode = parent;
  Vrml1Walker(builder, file).Visit(file.root.get(), state, depth);
}

} // namespace dspace
