#include <dspace/widgets/terrain/LayerList.h>

#include <algorithm>
#include <cmath>

#include <QDropEvent>
#include <QHeaderView>
#include <QKeyEvent>
#include <QSignalBlocker>

namespace dspace::widgets {

LayerList::LayerList(QWidget* parent) : QTreeWidget(parent) {
  this->setHeaderLabels({tr("Layer"), tr("Kind"), tr("Opacity")});
  this->setRootIsDecorated(false);
  this->setUniformRowHeights(true);
  this->setDragDropMode(QAbstractItemView::InternalMove);
  this->setDefaultDropAction(Qt::MoveAction);
  this->setSelectionMode(QAbstractItemView::SingleSelection);
  this->header()->setStretchLastSection(false);
  this->header()->setSectionResizeMode(0, QHeaderView::Stretch);
  this->header()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
  this->header()->setSectionResizeMode(2, QHeaderView::ResizeToContents);
  this->setAccessibleName(tr("Layers, top first"));
  connect(this, &QTreeWidget::itemChanged, this, [this](QTreeWidgetItem* item, int column) {
    if (column == 0) {
      emit this->visibleWanted(item->text(0), item->checkState(0) == Qt::Checked);
    }
  });
}

QString LayerList::KindText(int kind) {
  switch (kind) {
  case v1::TerrainLayerReply::IMAGE:
    return tr("image");
  case v1::TerrainLayerReply::FALSE_COLOR:
    return tr("false colour");
  case v1::TerrainLayerReply::SHAPES:
    return tr("shapes");
  case v1::TerrainLayerReply::NOISE:
    return tr("noise");
  case v1::TerrainLayerReply::NORMALS:
    return tr("normals");
  case v1::TerrainLayerReply::FILLED:
    return tr("filled ground");
  default:
    return tr("layer");
  }
}

void LayerList::Show(const v1::TerrainLayerList& layers, bool canChange) {
  this->CanChange_ = canChange;
  const QString selected = this->Selected();
  const QSignalBlocker silent(this);
  this->clear();
  for (int i = layers.layer_size() - 1; i >= 0; --i) {
    const v1::TerrainLayerReply& layer = layers.layer(i);
    auto* item = new QTreeWidgetItem(this);
    item->setText(0, QString::fromStdString(layer.name()));
    item->setCheckState(0, layer.visible() ? Qt::Checked : Qt::Unchecked);
    item->setText(1, KindText(layer.kind()));
    item->setText(2, tr("%1 %").arg(std::lround(100.0 * layer.opacity())));
    item->setTextAlignment(2, Qt::AlignRight | Qt::AlignVCenter);
    const Qt::ItemFlags changes = Qt::ItemIsUserCheckable | Qt::ItemIsDragEnabled;
    item->setFlags((canChange ? item->flags() | changes : item->flags() & ~changes) &
                   ~Qt::ItemIsDropEnabled);
    QString tip = QString::fromStdString(layer.path());
    if (!layer.field().empty()) {
      tip = tr("field %1").arg(QString::fromStdString(layer.field()));
    }
    if (std::isfinite(layer.pixel_size()) && layer.pixel_size() > 0.0) {
      tip += (tip.isEmpty() ? QString() : QStringLiteral("\n")) +
             tr("finest detail %1 m").arg(QString::number(layer.pixel_size(), 'g', 4));
    }
    item->setToolTip(0, tip);
    if (item->text(0) == selected) {
      this->setCurrentItem(item);
    }
  }
  if (!this->currentItem() && this->topLevelItemCount() > 0) {
    this->setCurrentItem(this->topLevelItem(0));
  }
}

QSize LayerList::sizeHint() const {
  constexpr int Rows = 5;
  const int row = std::max(this->sizeHintForRow(0), this->fontMetrics().height() + 2);
  return {220, this->header()->sizeHint().height() + Rows * row + 2 * this->frameWidth()};
}

QString LayerList::Selected() const {
  return this->currentItem() ? this->currentItem()->text(0) : QString();
}

void LayerList::Select(const QString& name) {
  for (int i = 0; i < this->topLevelItemCount(); ++i) {
    if (this->topLevelItem(i)->text(0) == name) {
      this->setCurrentItem(this->topLevelItem(i));
    }
  }
}

void LayerList::Move(int row, int to) {
  const int last = this->topLevelItemCount() - 1;
  to = std::clamp(to, 0, last);
  if (this->CanChange_ && row >= 0 && row != to) {
    emit this->positionWanted(this->topLevelItem(row)->text(0), last - to);
  }
}

void LayerList::dropEvent(QDropEvent* event) {
  const int from = this->indexOfTopLevelItem(this->currentItem());
  const QTreeWidgetItem* over = this->itemAt(event->position().toPoint());
  int before = this->topLevelItemCount(); // the row that it comes before
  if (over) {
    before = this->indexOfTopLevelItem(const_cast<QTreeWidgetItem*>(over));
    const QRect place = this->visualItemRect(over);
    before += event->position().y() > place.center().y() ? 1 : 0;
  }
  event->setDropAction(Qt::IgnoreAction); // the terrain says where it is
  event->accept();
  this->Move(from, before > from ? before - 1 : before);
}

void LayerList::keyPressEvent(QKeyEvent* event) {
  const int row = this->indexOfTopLevelItem(this->currentItem());
  if (event->modifiers() == Qt::AltModifier && event->key() == Qt::Key_Up) {
    this->Move(row, row - 1);
  } else if (event->modifiers() == Qt::AltModifier && event->key() == Qt::Key_Down) {
    this->Move(row, row + 1);
  } else if (event->key() == Qt::Key_Delete && row >= 0 && this->CanChange_) {
    emit this->removeWanted(this->Selected());
  } else {
    QTreeWidget::keyPressEvent(event);
  }
}

} // namespace dspace::widgets
