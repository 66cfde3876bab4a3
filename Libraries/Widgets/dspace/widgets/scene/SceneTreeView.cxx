#include <dspace/widgets/scene/SceneTreeView.h>

#include <algorithm>
#include <utility>

#include <QAccessible>
#include <QApplication>
#include <QHeaderView>
#include <QKeyEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QStyledItemDelegate>

#include <dspace/widgets/scene/SceneTreeIcons.h>

namespace dspace::widgets {
namespace {

constexpr int IconEdge = 16;

class SceneTreeDelegate : public QStyledItemDelegate {
public:
  using QStyledItemDelegate::QStyledItemDelegate;

  void initStyleOption(QStyleOptionViewItem* option, const QModelIndex& index) const override {
    QStyledItemDelegate::initStyleOption(option, index);
    if (index.column() == SceneTreeModel::NameColumn) {
      option->features |= QStyleOptionViewItem::HasDecoration;
      option->icon = SceneIcon(SceneTreeModel::Icon(index.data(SceneTreeModel::IconRole).toInt()),
                               option->palette);
      option->decorationSize = {IconEdge, IconEdge};
    }
    if (index.column() != SceneTreeModel::VisibleColumn &&
        index.data(SceneTreeModel::DimmedRole).toBool()) {
      QColor pale = option->palette.color(QPalette::Active, QPalette::Text);
      pale.setAlphaF(0.55f); // disabled text is too pale to read on some palettes
      for (const auto group : {QPalette::Active, QPalette::Inactive}) {
        option->palette.setColor(group, QPalette::Text, pale);
      }
    }
  }

  void paint(QPainter* painter, const QStyleOptionViewItem& option,
             const QModelIndex& index) const override {
    QStyledItemDelegate::paint(painter, option, index);
    if (index.column() == SceneTreeModel::VisibleColumn) {
      const auto eye = SceneTreeModel::Eye(index.data(SceneTreeModel::EyeRole).toInt());
      if (eye != SceneTreeModel::Eye::None) {
        EyeIcon(eye, option.palette)
            .paint(painter, option.rect, Qt::AlignCenter,
                   option.state.testFlag(QStyle::State_Selected) ? QIcon::Selected : QIcon::Normal);
      }
    }
  }

  QSize sizeHint(const QStyleOptionViewItem& option, const QModelIndex& index) const override {
    const QSize size = QStyledItemDelegate::sizeHint(option, index);
    return {size.width(), std::max(size.height(), IconEdge + 6)};
  }
};

} // namespace

SceneTreeView::SceneTreeView(SceneTreeModel* model, QWidget* parent) : QTreeView(parent) {
  this->setModel(model);
  this->setItemDelegate(new SceneTreeDelegate(this));
  this->setUniformRowHeights(true);
  this->setSelectionBehavior(QAbstractItemView::SelectRows);
  this->setSelectionMode(QAbstractItemView::SingleSelection);
  this->setAlternatingRowColors(true);
  this->setContextMenuPolicy(Qt::CustomContextMenu);
  this->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->setVerticalScrollMode(QAbstractItemView::ScrollPerPixel);
  this->setTextElideMode(Qt::ElideRight);
  this->setIndentation(IconEdge);
  QHeaderView& header = *this->header();
  header.setStretchLastSection(false);
  header.setResizeContentsPrecision(0); // of the rows in view only
  header.setMinimumSectionSize(IconEdge);
  header.setSectionResizeMode(SceneTreeModel::NameColumn, QHeaderView::Fixed); // FitNames
  header.setSectionResizeMode(SceneTreeModel::VisibleColumn, QHeaderView::Fixed);
  header.resizeSection(SceneTreeModel::VisibleColumn, IconEdge + 12);
  const QFontMetrics metrics(this->font());
  header.resizeSection(SceneTreeModel::NatureColumn, metrics.horizontalAdvance("ornamental") + 12);
  header.resizeSection(SceneTreeModel::KindColumn, metrics.horizontalAdvance("primitive") + 12);
  connect(this, &QTreeView::expanded, this, &SceneTreeView::FitNames);
  connect(this, &QTreeView::collapsed, this, &SceneTreeView::FitNames);
  connect(&header, &QHeaderView::sectionResized, this, [this](int section) {
    if (section != SceneTreeModel::NameColumn) {
      this->FitNames();
    }
  });
}

void SceneTreeView::FitNames() {
  if (this->Fitting_) {
    return; // a scroll bar that comes and goes resizes the view
  }
  this->Fitting_ = true;
  int left = this->viewport()->width();
  for (int column = 0; column < this->header()->count(); ++column) {
    left -= column == SceneTreeModel::NameColumn ? 0 : this->columnWidth(column);
  }
  constexpr int Widest = 1200;
  const int needed = std::min(this->sizeHintForColumn(SceneTreeModel::NameColumn), Widest);
  const int width = std::max(left, needed);
  if (width != this->columnWidth(SceneTreeModel::NameColumn)) {
    this->setColumnWidth(SceneTreeModel::NameColumn, width);
  }
  this->Fitting_ = false;
}

void SceneTreeView::resizeEvent(QResizeEvent* event) {
  QTreeView::resizeEvent(event);
  this->FitNames();
}

void SceneTreeView::dataChanged(const QModelIndex& topLeft, const QModelIndex& bottomRight,
                                const QList<int>& roles) {
  // The height of rows never changes. QTreeView would search its rows for each changed one.
  if (QAccessible::isActive()) {
    QTreeView::dataChanged(topLeft, bottomRight, roles);
  }
  if (!this->Painted_ || !topLeft.isValid()) {
    return;
  }
  const void* parent = topLeft.parent().internalPointer();
  const auto first = std::lower_bound(this->InView_.begin(), this->InView_.end(),
                                      std::make_pair(parent, topLeft.row()));
  if (first != this->InView_.end() && first->first == parent &&
      first->second <= bottomRight.row()) {
    this->Painted_ = false;
    this->viewport()->update();
  }
}

void SceneTreeView::paintEvent(QPaintEvent* event) {
  QTreeView::paintEvent(event);
  ++this->Paintings_;
  const auto before = std::exchange(this->InView_, {});
  const int bottom = this->viewport()->height();
  for (QModelIndex index = this->indexAt({0, 0}); index.isValid();
       index = this->indexBelow(index)) {
    if (this->visualRect(index).top() > bottom) {
      break;
    }
    this->InView_.emplace_back(index.parent().internalPointer(), index.row());
  }
  std::sort(this->InView_.begin(), this->InView_.end());
  if (this->InView_ != before) { // other names
    QMetaObject::invokeMethod(this, &SceneTreeView::FitNames, Qt::QueuedConnection);
  }
  this->Painted_ = true;
}

bool SceneTreeView::OnEye(const QMouseEvent& event) {
  const QModelIndex index = this->indexAt(event.position().toPoint());
  return event.button() == Qt::LeftButton && index.isValid() &&
         index.column() == SceneTreeModel::VisibleColumn &&
         index.data(SceneTreeModel::EyeRole).toInt() != int(SceneTreeModel::Eye::None);
}

void SceneTreeView::mousePressEvent(QMouseEvent* event) {
  if (this->OnEye(*event)) {
    this->EyePressed_ = true;
    emit this->eyeClicked(this->indexAt(event->position().toPoint()));
    return;
  }
  QTreeView::mousePressEvent(event);
}

void SceneTreeView::mouseDoubleClickEvent(QMouseEvent* event) {
  if (this->OnEye(*event)) {
    this->mousePressEvent(event);
    return;
  }
  QTreeView::mouseDoubleClickEvent(event);
}

void SceneTreeView::mouseReleaseEvent(QMouseEvent* event) {
  if (this->EyePressed_) {
    this->EyePressed_ = false;
    return;
  }
  QTreeView::mouseReleaseEvent(event);
}

void SceneTreeView::keyPressEvent(QKeyEvent* event) {
  if (event->key() == Qt::Key_Space && this->currentIndex().isValid()) {
    emit this->eyeClicked(this->currentIndex());
    return;
  }
  QTreeView::keyPressEvent(event);
}

} // namespace dspace::widgets
