#include <dspace/widgets/desktop/AboutText.h>

#include <QGuiApplication>
#include <QOpenGLContext>
#include <QOpenGLFunctions>
#include <QScreen>
#include <QSysInfo>

#include "vtkDspaceRenderContext.h"
#include "vtkRenderWindow.h"
#include "vtkVersion.h"

namespace dspace::widgets {

QString AboutText(vtkDspaceRenderContext* context, const QString& version) {
  QStringList lines;
  lines << "Dspace: " + version;
  lines << QStringLiteral("Qt: ") + qVersion();
  lines << QStringLiteral("VTK: ") + vtkVersion::GetVTKVersion();
  const QString renderer = QString::fromStdString(context->GetRendererName());
  QString vendor;
  context->GetRenderWindow()->MakeCurrent();
  if (QOpenGLContext* current = QOpenGLContext::currentContext()) {
    vendor = QString::fromLatin1(
        reinterpret_cast<const char*>(current->functions()->glGetString(GL_VENDOR)));
  }
  lines << "OpenGL vendor: " + (vendor.isEmpty() ? QStringLiteral("not known") : vendor);
  lines << "OpenGL renderer: " + renderer;
  lines << "OpenGL version: " + QString::fromStdString(context->GetVersion());
  const QScreen* screen = QGuiApplication::primaryScreen();
  lines << QStringLiteral("Screen: %1 x %2 at %3, by %4")
               .arg(screen ? screen->size().width() : 0)
               .arg(screen ? screen->size().height() : 0)
               .arg(screen ? screen->devicePixelRatio() : 0.0)
               .arg(QGuiApplication::platformName());
  lines << "System: " + QSysInfo::prettyProductName() + ", " + QSysInfo::kernelType() + " " +
               QSysInfo::kernelVersion() + ", " + QSysInfo::currentCpuArchitecture();
  return lines.join('\n');
}

} // namespace dspace::widgets
