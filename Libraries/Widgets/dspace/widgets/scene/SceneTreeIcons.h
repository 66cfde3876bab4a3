// Icons of a scene tree, drawn in the colours of a palette.
#ifndef DSPACE_WIDGETS_SCENE_TREE_ICONS_H
#define DSPACE_WIDGETS_SCENE_TREE_ICONS_H

#include <QIcon>
#include <QPalette>

#include <dspace/widgets/scene/SceneTreeModel.h>

namespace dspace::widgets {

// 16 × 16, with pixels for screens of up to three times the density. They are made once for each
// palette. The selected mode is for highlighted rows.
QIcon SceneIcon(SceneTreeModel::Icon icon, const QPalette& palette);
QIcon EyeIcon(SceneTreeModel::Eye eye, const QPalette& palette); // null for Eye::None

} // namespace dspace::widgets

#endif
