#include <dspace/widgets/telemetry/TelemetryTableWidget.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <QElapsedTimer>
#include <QHeaderView>
#include <QKeyEvent>
#include <QLabel>
#include <QLineEdit>
#include <QSortFilterProxyModel>
#include <QTableView>
#include <QTimer>
#include <QVBoxLayout>

#include <dspace/widgets/telemetry/TelemetryModel.h>

namespace dspace::widgets {
namespace {

constexpr int TableTick_ms = 34; // at most 30 times a second
constexpr int LeastShare = 20;   // of the time between looks that a look may take

// Sorts, and leaves out what lacks a word.
class SearchModel : public QSortFilterProxyModel {
public:
  using QSortFilterProxyModel::QSortFilterProxyModel;

  void SetWords(const QStringList& words) {
    this->Words_ = words;
    this->invalidateFilter();
  }

protected:
  bool filterAcceptsRow(int row, const QModelIndex& parent) const override {
    if (this->Words_.isEmpty()) {
      return true;
    }
    const QString text =
        this->sourceModel()->index(row, 0, parent).data(TelemetryModel::SearchRole).toString();
    return std::all_of(this->Words_.begin(), this->Words_.end(), [&](const QString& word) {
      return text.contains(word, Qt::CaseInsensitive);
    });
  }
  // Numbers by size before texts; what has no number is least.
  bool lessThan(const QModelIndex& left, const QModelIndex& right) const override {
    const QVariant a = left.data(TelemetryModel::SortRole);
    const QVariant b = right.data(TelemetryModel::SortRole);
    const bool numberA = a.typeId() == QMetaType::Double;
    const bool numberB = b.typeId() == QMetaType::Double;
    if (numberA != numberB) {
      return numberA;
    }
    if (!numberA) {
      return QString::compare(a.toString(), b.toString(), Qt::CaseInsensitive) < 0;
    }
    const double x = a.toDouble();
    const double y = b.toDouble();
    return std::isnan(x) ? !std::isnan(y) : x < y;
  }

private:
  QStringList Words_;
};

} // namespace

struct TelemetryTableWidget::Internals {
  TelemetrySource source;
  TelemetryModel* model = nullptr;
  SearchModel* sorted = nullptr;
  QTableView* view = nullptr;
  QLineEdit* search = nullptr;
  QLabel* empty = nullptr; // says why there is no row
  QTimer ticks;

  void ShowEmpty() {
    const bool none = this->sorted->rowCount() == 0;
    if (none) {
      this->empty->setText(
          this->model->rowCount() == 0
              ? QString("No telemetry channels")
              : QString("No channel has \u201c%1\u201d").arg(this->search->text()));
      this->empty->setGeometry(this->view->viewport()->rect());
    }
    this->empty->setVisible(none);
  }
};

TelemetryTableWidget::TelemetryTableWidget(QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>()) {
  Internals& self = *this->Impl_;
  self.model = new TelemetryModel(this);
  self.sorted = new SearchModel(this);
  self.sorted->setSourceModel(self.model);
  self.sorted->setSortRole(TelemetryModel::SortRole);
  self.sorted->setFilterRole(TelemetryModel::SearchRole); // which changes of values leave alone
  self.search = new QLineEdit;
  self.search->setPlaceholderText("Search channels");
  self.search->setToolTip("Words in the name, unit or description of a channel");
  self.search->setAccessibleName("Search channels");
  self.search->setClearButtonEnabled(true);
  self.view = new QTableView;
  self.view->setModel(self.sorted);
  self.view->setAccessibleName("Telemetry");
  self.view->setSelectionBehavior(QAbstractItemView::SelectRows);
  self.view->setSelectionMode(QAbstractItemView::ExtendedSelection);
  self.view->setEditTriggers(QAbstractItemView::NoEditTriggers);
  self.view->setDragEnabled(true);
  self.view->setDragDropMode(QAbstractItemView::DragOnly);
  self.view->setShowGrid(false);
  self.view->setAlternatingRowColors(true);
  self.view->setWordWrap(false);
  self.view->setTabKeyNavigation(false);
  self.view->setSortingEnabled(true);
  self.view->sortByColumn(TelemetryModel::Name, Qt::AscendingOrder);
  self.view->verticalHeader()->hide();
  // Rows of one height, so that 100,000 of them scroll.
  self.view->verticalHeader()->setSectionResizeMode(QHeaderView::Fixed);
  self.view->verticalHeader()->setDefaultSectionSize(self.view->fontMetrics().height() + 6);
  QHeaderView& header = *self.view->horizontalHeader();
  header.setHighlightSections(false);
  header.setSectionsMovable(true);
  const int digit = self.view->fontMetrics().horizontalAdvance('0');
  header.setMinimumSectionSize(6 * digit);
  header.setSectionResizeMode(TelemetryModel::Name, QHeaderView::Stretch);
  const int widths[] = {0, 16, 8, 11, 11, 11, 11};
  for (int i = TelemetryModel::Value; i < TelemetryModel::Columns; ++i) {
    header.resizeSection(i, widths[i] * digit);
  }
  self.empty = new QLabel(self.view->viewport());
  self.empty->setAlignment(Qt::AlignCenter);
  self.empty->setWordWrap(true);
  self.empty->setEnabled(false);
  self.empty->setAttribute(Qt::WA_TransparentForMouseEvents);
  auto* layout = new QVBoxLayout(this);
  layout->setContentsMargins(0, 0, 0, 0);
  layout->setSpacing(4);
  layout->addWidget(self.search);
  layout->addWidget(self.view);
  this->setFocusProxy(self.view);

  connect(self.search, &QLineEdit::textChanged, this, [this](const QString& text) {
    this->Impl_->sorted->SetWords(text.split(' ', Qt::SkipEmptyParts));
    this->Impl_->ShowEmpty();
  });
  connect(self.view, &QTableView::doubleClicked, this, [this](const QModelIndex& index) {
    emit this->activated(index.siblingAtColumn(TelemetryModel::Name).data().toString());
  });
  connect(self.view->selectionModel(), &QItemSelectionModel::selectionChanged, this,
          &TelemetryTableWidget::selectionChanged);
  connect(&self.ticks, &QTimer::timeout, this, [this] {
    QElapsedTimer clock;
    clock.start();
    this->Refresh();
    this->Impl_->ticks.setInterval(std::max(TableTick_ms, LeastShare * int(clock.elapsed())));
  });
  self.view->viewport()->installEventFilter(this);
  self.view->installEventFilter(this);
  self.search->installEventFilter(this);
  self.ShowEmpty();
}

TelemetryTableWidget::~TelemetryTableWidget() = default;

void TelemetryTableWidget::SetSource(TelemetrySource source) {
  this->Impl_->source = std::move(source);
  this->Impl_->model->Refresh(nullptr);
  this->Refresh();
}

void TelemetryTableWidget::SetSearch(const QString& words) {
  this->Impl_->search->setText(words);
}

QStringList TelemetryTableWidget::Selected() const {
  QList<int> rows;
  for (const QModelIndex& index : this->Impl_->view->selectionModel()->selectedRows()) {
    rows += index.row();
  }
  std::sort(rows.begin(), rows.end());
  QStringList names;
  for (const int row : rows) {
    names += this->Impl_->sorted->index(row, TelemetryModel::Name).data().toString();
  }
  return names;
}

void TelemetryTableWidget::Refresh() {
  Internals& self = *this->Impl_;
  self.model->Refresh(self.source ? self.source() : nullptr);
  self.ShowEmpty();
}

TelemetryModel* TelemetryTableWidget::Model() const {
  return this->Impl_->model;
}
QTableView* TelemetryTableWidget::View() const {
  return this->Impl_->view;
}
QLineEdit* TelemetryTableWidget::SearchField() const {
  return this->Impl_->search;
}
QSize TelemetryTableWidget::sizeHint() const {
  const int digit = this->fontMetrics().horizontalAdvance('0');
  return {100 * digit, 20 * this->fontMetrics().height()};
}

void TelemetryTableWidget::showEvent(QShowEvent* event) {
  this->Refresh();
  this->Impl_->ticks.start(TableTick_ms);
  QWidget::showEvent(event);
}

void TelemetryTableWidget::hideEvent(QHideEvent* event) {
  this->Impl_->ticks.stop();
  QWidget::hideEvent(event);
}

bool TelemetryTableWidget::eventFilter(QObject* watched, QEvent* event) {
  Internals& self = *this->Impl_;
  if (watched == self.view->viewport() && event->type() == QEvent::Resize) {
    self.empty->setGeometry(self.view->viewport()->rect());
  } else if (event->type() == QEvent::KeyPress) {
    const auto& key = static_cast<const QKeyEvent&>(*event);
    if (watched == self.search && key.key() == Qt::Key_Escape) {
      self.search->clear();
      return true;
    }
    if (watched == self.search && key.key() == Qt::Key_Down) {
      self.view->setFocus();
      return true;
    }
    if (watched == self.view && (key.key() == Qt::Key_Return || key.key() == Qt::Key_Enter)) {
      for (const QString& name : this->Selected()) {
        emit this->activated(name);
      }
      return true;
    }
    if (watched == self.view && key.matches(QKeySequence::Find)) {
      self.search->setFocus();
      return true;
    }
  }
  return QWidget::eventFilter(watched, event);
}

} // namespace dspace::widgets
