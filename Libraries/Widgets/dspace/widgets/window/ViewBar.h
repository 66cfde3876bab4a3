// The bar of a view: what it looks through and how it shows it.
#ifndef DSPACE_WIDGETS_VIEW_BAR_H
#define DSPACE_WIDGETS_VIEW_BAR_H

#include <functional>
#include <memory>
#include <string>

#include <QWidget>

#include <dspace/widgets/viewport/ShownSession.h>

class QComboBox;
class QMenu;
class QToolButton;

namespace dspace::widgets {

class ViewportWidget;

// The title bar of a view's dock. Menus are filled when they open, from the session's state as it
// is then. Each entry is a line of Python on app.views[...].
class ViewBar : public QWidget {
  Q_OBJECT

public:
  using Run = std::function<bool(const QString& python)>;

  ViewBar(ViewportWidget* widget, const ShownSession& session, const std::string& viewport,
          const QString& title, Run run, QWidget* parent = nullptr);
  ~ViewBar() override;

  // "camera", "show", "style", "window"; filled as if it opened now.
  QMenu* Menu(const QString& name);

protected:
  void resizeEvent(QResizeEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
