// The dark and the light look of windows.
#ifndef DSPACE_WIDGETS_THEME_H
#define DSPACE_WIDGETS_THEME_H

#include <optional>

#include <QColor>
#include <QPalette>
#include <QString>

namespace dspace::widgets {

enum class Theme { System, Dark, Light };

QString WordOf(Theme theme); // system, dark, light
std::optional<Theme> ThemeOf(const QString& word);

// Of a theme; System: the palette that the application started with.
QPalette PaletteOf(Theme theme);
// Gives the application the theme's palette, and OutlinedStyle, which follows palettes, for Dark
// and Light. Widgets that are there already follow.
void ApplyTheme(Theme theme);
bool IsDark(const QPalette& palette);

// Colours of texts on QPalette::Base that stand out in both themes.
enum class Accent {
  Error,   // what went wrong
  Input,   // lines of Python
  Warning, // amber
};
QColor AccentOf(Accent accent, const QPalette& palette);

// The contrast of two opaque colours, 1 to 21 (WCAG 2.1, "contrast ratio"). Texts need 4.5, lines
// and marks of controls 3.
double ContrastOf(const QColor& a, const QColor& b);

} // namespace dspace::widgets

#endif
