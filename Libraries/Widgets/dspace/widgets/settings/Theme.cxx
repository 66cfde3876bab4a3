#include <dspace/widgets/settings/Theme.h>

#include <algorithm>
#include <cmath>

#include <QApplication>
#include <QStyle>
#include <QStyleFactory>

#include <dspace/widgets/settings/OutlinedStyle.h>

namespace dspace::widgets {
namespace {

struct Colors {
  QRgb window, text, base, alternate, button, tip, tipText, highlight, highlighted, link, visited,
      dim, disabled;
};

constexpr Colors Dark = {0x26282c, 0xe8eaed, 0x1b1d20, 0x222529, 0x33363b, 0x3a3d42, 0xf1f3f4,
                         0x2f6fc4, 0xffffff, 0x8ab4f8, 0xc58af9, 0xa3a8ae, 0x85898e};
constexpr Colors Light = {0xf0f1f3, 0x1b1d20, 0xffffff, 0xf5f6f8, 0xe6e8eb, 0xfffbe6, 0x1b1d20,
                          0x1f5fb8, 0xffffff, 0x0b57d0, 0x6f3fa0, 0x5f656b, 0x73787e};

QPalette Make(const Colors& c) {
  // The shades of frames come from these two.
  QPalette palette{QColor(c.button), QColor(c.window)};
  const auto all = [&](QPalette::ColorRole role, QRgb color) {
    palette.setColor(role, QColor(color));
  };
  all(QPalette::Window, c.window);
  all(QPalette::Base, c.base);
  all(QPalette::AlternateBase, c.alternate);
  all(QPalette::Button, c.button);
  all(QPalette::ToolTipBase, c.tip);
  all(QPalette::ToolTipText, c.tipText);
  all(QPalette::Highlight, c.highlight);
  all(QPalette::HighlightedText, c.highlighted);
  all(QPalette::Link, c.link);
  all(QPalette::LinkVisited, c.visited);
  all(QPalette::PlaceholderText, c.dim);
  all(QPalette::BrightText, 0xffffff);
  for (const auto role : {QPalette::WindowText, QPalette::Text, QPalette::ButtonText}) {
    all(role, c.text);
    palette.setColor(QPalette::Disabled, role, QColor(c.disabled));
  }
  palette.setColor(QPalette::Disabled, QPalette::Highlight, QColor(c.button));
  palette.setColor(QPalette::Disabled, QPalette::HighlightedText, QColor(c.disabled));
  return palette;
}

// What the application started with.
struct Started {
  QPalette palette = QApplication::palette();
  QString style = QApplication::style()->name();
};

const Started& AtStart() {
  static const Started started;
  return started;
}

// Relative luminance of WCAG 2.1.
double Luminance(const QColor& color) {
  const auto linear = [](double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(color.redF()) + 0.7152 * linear(color.greenF()) +
         0.0722 * linear(color.blueF());
}

} // namespace

QString WordOf(Theme theme) {
  return theme == Theme::Dark    ? QStringLiteral("dark")
         : theme == Theme::Light ? QStringLiteral("light")
                                 : QStringLiteral("system");
}

std::optional<Theme> ThemeOf(const QString& word) {
  for (const Theme each : {Theme::System, Theme::Dark, Theme::Light}) {
    if (word == WordOf(each)) {
      return each;
    }
  }
  return std::nullopt;
}

QPalette PaletteOf(Theme theme) {
  return theme == Theme::Dark    ? Make(Dark)
         : theme == Theme::Light ? Make(Light)
                                 : AtStart().palette;
}

void ApplyTheme(Theme theme) {
  AtStart(); // before it changes
  const bool outlined = qobject_cast<OutlinedStyle*>(QApplication::style()) != nullptr;
  if (theme != Theme::System && !outlined) {
    QApplication::setStyle(new OutlinedStyle);
  } else if (theme == Theme::System && outlined) {
    QApplication::setStyle(QStyleFactory::create(AtStart().style));
  }
  QApplication::setPalette(PaletteOf(theme));
}

bool IsDark(const QPalette& palette) {
  return palette.color(QPalette::Base).lightness() < 128;
}

QColor AccentOf(Accent accent, const QPalette& palette) {
  const bool dark = IsDark(palette);
  switch (accent) {
  case Accent::Error:
    return QColor(dark ? 0xff8a80 : 0xb3261e);
  case Accent::Input:
    return QColor(dark ? 0x8ab4f8 : 0x0b57d0);
  case Accent::Warning:
    return QColor(dark ? 0xffc247 : 0x8a5300);
  }
  return palette.color(QPalette::Text);
}

double ContrastOf(const QColor& a, const QColor& b) {
  const double la = Luminance(a);
  const double lb = Luminance(b);
  return (std::max(la, lb) + 0.05) / (std::min(la, lb) + 0.05);
}

} // namespace dspace::widgets
