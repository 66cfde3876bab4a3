#include <dspace/widgets/window/ExportDialog.h>

#include <algorithm>
#include <cmath>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QDir>
#include <QDoubleSpinBox>
#include <QFileDialog>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QLineEdit>
#include <QPushButton>
#include <QRegularExpression>
#include <QSpinBox>
#include <QThread>
#include <QTimer>

#include <dspace/widgets/script/PythonText.h>

namespace dspace::widgets {
namespace {

constexpr int LargestSide = 16384;

// Width and height; (0, 0) for other texts.
QSize SizeOf(const QString& text) {
  static const QRegularExpression form(
      QStringLiteral("^\\s*(\\d{1,5})\\s*[xX\u00d7]\\s*(\\d{1,5})\\s*$"));
  const QRegularExpressionMatch match = form.match(text);
  const QSize size(match.captured(1).toInt(), match.captured(2).toInt());
  return match.hasMatch() && size.width() >= 1 && size.height() >= 1 &&
                 size.width() <= LargestSide && size.height() <= LargestSide
             ? size
             : QSize(0, 0);
}

// Of the last export of this process.
QString& LastFolder() {
  static QString folder = QDir::homePath();
  return folder;
}

bool IsVideo(const QString& path) {
  return path.endsWith(QStringLiteral(".mp4"), Qt::CaseInsensitive) ||
         path.endsWith(QStringLiteral(".webm"), Qt::CaseInsensitive);
}

} // namespace

ExportDialog::ExportDialog(const QJsonArray& size, double rate, int samples, double duration_s,
                           QWidget* parent)
    : QDialog(parent), Duration_s(duration_s) {
  this->setWindowTitle(tr("Export movie"));
  auto* form = new QFormLayout(this);
  auto* row = new QHBoxLayout;
  const QString& folder = LastFolder();
  this->Path_ = new QLineEdit(QDir(folder).filePath(QStringLiteral("movie.mp4")));
  this->Path_->setObjectName("path");
  this->Path_->setMinimumWidth(360);
  this->Path_->setToolTip(
      tr("X.mp4 (H.264), X.webm (VP9), or a folder of PNGs: a name without a dot"));
  auto* browse = new QPushButton(tr("Browse..."));
  row->addWidget(this->Path_, 1);
  row->addWidget(browse);
  form->addRow(tr("File"), row);
  this->Size_ = new QComboBox;
  this->Size_->setObjectName("size");
  this->Size_->setEditable(true);
  const QString own = size.size() == 2
                          ? QString("%1 x %2").arg(size[0].toInt()).arg(size[1].toInt())
                          : QStringLiteral("1280 x 720");
  this->Size_->addItem(own);
  for (const char* usual : {"1280 x 720", "1920 x 1080", "2560 x 1440", "3840 x 2160"}) {
    if (own != usual) {
      this->Size_->addItem(usual);
    }
  }
  this->Size_->setToolTip(tr("Pixels; even numbers for video files"));
  form->addRow(tr("Size"), this->Size_);
  this->Rate_ = new QDoubleSpinBox;
  this->Rate_->setObjectName("rate");
  this->Rate_->setRange(0.01, 1000.0);
  this->Rate_->setDecimals(3);
  this->Rate_->setValue(rate);
  this->Rate_->setSuffix(tr(" pictures/s"));
  form->addRow(tr("Rate"), this->Rate_);
  this->Samples_ = new QSpinBox;
  this->Samples_->setObjectName("samples");
  this->Samples_->setRange(1, 8);
  this->Samples_->setValue(samples);
  this->Samples_->setToolTip(tr("Samples a pixel along each side"));
  form->addRow(tr("Samples"), this->Samples_);
  this->Jobs_ = new QSpinBox;
  this->Jobs_->setObjectName("jobs");
  this->Jobs_->setRange(1, 64);
  this->Jobs_->setValue(std::clamp(QThread::idealThreadCount() / 2, 1, 8));
  this->Jobs_->setToolTip(tr("Processes that draw; each opens the recording"));
  form->addRow(tr("Jobs"), this->Jobs_);
  this->Note_ = new QLabel;
  this->Note_->setWordWrap(true);
  form->addRow(this->Note_);
  this->Buttons_ = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel);
  this->Buttons_->button(QDialogButtonBox::Ok)->setText(tr("Export"));
  this->Buttons_->button(QDialogButtonBox::Ok)->setObjectName("export");
  connect(this->Buttons_, &QDialogButtonBox::accepted, this, [this] {
    LastFolder() = QFileInfo(this->Path_->text()).path();
    QTimer::singleShot(0, this, &QDialog::accept); // it ends after the button's event
  });
  connect(this->Buttons_, &QDialogButtonBox::rejected, this, &QDialog::reject);
  form->addRow(this->Buttons_);
  connect(browse, &QPushButton::clicked, this, [this] {
    auto* dialog = new QFileDialog(this, tr("Export movie"), this->Path_->text(),
                                   tr("Movies (*.mp4 *.webm);;Folders of PNGs (*)"));
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setAcceptMode(QFileDialog::AcceptSave);
    connect(dialog, &QFileDialog::fileSelected, this->Path_, &QLineEdit::setText);
    dialog->open();
  });
  connect(this->Path_, &QLineEdit::textChanged, this, [this] { this->Check(); });
  connect(this->Size_, &QComboBox::currentTextChanged, this, [this] { this->Check(); });
  connect(this->Rate_, &QDoubleSpinBox::valueChanged, this, [this] { this->Check(); });
  this->Check();
}

void ExportDialog::Check() {
  const QSize size = SizeOf(this->Size_->currentText());
  const QString path = this->Path_->text().trimmed();
  const QString ending = QFileInfo(path).fileName();
  QString fault;
  if (size.isEmpty()) {
    fault = tr("The size is %1; accepted: such as 1920 x 1080, 1 to %2 a side")
                .arg(this->Size_->currentText())
                .arg(LargestSide);
  } else if (path.isEmpty()) {
    fault = tr("A file is needed");
  } else if (ending.contains('.') && !IsVideo(path)) {
    fault = tr("Accepted are .mp4, .webm, or a folder: a name without a dot");
  } else if (IsVideo(path) && (size.width() % 2 != 0 || size.height() % 2 != 0)) {
    fault = tr("Video files need even numbers of pixels");
  }
  const double count = std::max(1.0, std::round(this->Duration_s * this->Rate_->value()));
  this->Note_->setText(!fault.isEmpty()
                           ? fault
                           : tr("%1 pictures, %2 s%3")
                                 .arg(count, 0, 'f', 0)
                                 .arg(this->Duration_s, 0, 'g', 6)
                                 .arg(IsVideo(path) ? tr("; a file that is there is replaced when "
                                                         "the movie is complete")
                                                    : QString()));
  this->Buttons_->button(QDialogButtonBox::Ok)->setEnabled(fault.isEmpty());
}

QString ExportDialog::Line() const {
  const QSize size = SizeOf(this->Size_->currentText());
  return QStringLiteral("app.export_movie(%1, size=(%2, %3), rate=%4, samples=%5, jobs=%6)")
      .arg(Quoted(this->Path_->text().trimmed()))
      .arg(size.width())
      .arg(size.height())
      .arg(PythonOf(this->Rate_->value()))
      .arg(this->Samples_->value())
      .arg(this->Jobs_->value());
}

} // namespace dspace::widgets
