// Preferences: what is not accepted is the default's; the dialog tells what is chosen; units.
#include <gtest/gtest.h>

#include <QComboBox>
#include <QDialogButtonBox>
#include <QJsonObject>
#include <QPushButton>
#include <QSpinBox>
#include <QTemporaryDir>
#include <QtTest>

#include <dspace/widgets/settings/Preferences.h>
#include <dspace/widgets/settings/PreferencesDialog.h>
#include <dspace/widgets/settings/SettingsFile.h>

#include "OneApplication.h"

using namespace dspace::widgets;

TEST(Preferences, AreWrittenAndRead) {
  QTemporaryDir folder;
  SettingsFile file(folder.filePath("settings.json"));
  EXPECT_EQ(Preferences::Read(file), Preferences());
  Preferences chosen;
  chosen.theme = Theme::Dark;
  chosen.samples = 4;
  chosen.navigation = "walk";
  chosen.units = {UnitChoice::Length::Kilometre, UnitChoice::Angle::Radian, true, true};
  chosen.recentFiles = 0;
  chosen.restoreLayout = false;
  ASSERT_TRUE(chosen.Write(file));
  EXPECT_EQ(Preferences::Read(SettingsFile(file.Path())), chosen);
}

TEST(Preferences, WhatIsNotAcceptedIsTheDefaults) {
  QTemporaryDir folder;
  SettingsFile file(folder.filePath("settings.json"));
  ASSERT_TRUE(file.Set("preferences", QJsonObject{{"theme", "pink"},
                                                  {"samples", 99},
                                                  {"navigation", 3},
                                                  {"length", "parsec"},
                                                  {"angle", QJsonValue::Null},
                                                  {"inertial", 1},
                                                  {"recentFiles", -1},
                                                  {"restoreLayout", "no"}}));
  EXPECT_EQ(Preferences::Read(file), Preferences());
  ASSERT_TRUE(file.Set("preferences", 7));
  EXPECT_EQ(Preferences::Read(file), Preferences());
}

TEST(Preferences, UnitsConvert) {
  const UnitChoice plain;
  EXPECT_EQ(plain.LengthFactor(), 1.0);
  EXPECT_EQ(plain.AngleFactor(), 1.0);
  const UnitChoice other{UnitChoice::Length::Kilometre, UnitChoice::Angle::Radian, false, false};
  EXPECT_DOUBLE_EQ(other.LengthFactor() * 1500.0, 1.5);
  EXPECT_NEAR(other.AngleFactor() * 180.0, 3.14159265358979, 1e-14);
  EXPECT_EQ(other.LengthUnit(), "km");
  EXPECT_EQ(other.AngleUnit(), "rad");
  EXPECT_EQ(other.LengthDecimals(4), 7); // a tenth of a millimetre still
}

TEST(PreferencesDialog, TellsWhatIsChosen) {
  PreferencesDialog dialog{Preferences()};
  Preferences told;
  int times = 0;
  QObject::connect(&dialog, &PreferencesDialog::chosen, [&](const Preferences& given) {
    told = given;
    ++times;
  });
  dialog.show();
  ASSERT_TRUE(QTest::qWaitForWindowActive(&dialog));
  // By keyboard alone: each control is reached by Tab, each has a tip.
  QSet<QWidget*> reached;
  for (int i = 0; i < 30; ++i) {
    reached.insert(QApplication::focusWidget());
    QTest::keyClick(QApplication::focusWidget(), Qt::Key_Tab);
  }
  for (QWidget* control : dialog.findChildren<QWidget*>()) {
    if (control->focusPolicy() & Qt::TabFocus && control->isVisible() && !control->focusProxy()) {
      const bool within = reached.contains(control) || reached.contains(control->parentWidget());
      EXPECT_TRUE(within) << control->metaObject()->className();
    }
  }
  for (QPushButton* button : dialog.findChildren<QPushButton*>()) {
    EXPECT_TRUE(reached.contains(button)) << button->text().toStdString();
  }
  auto* theme = dialog.findChildren<QComboBox*>().at(0);
  theme->setFocus();
  QTest::keyClick(theme, Qt::Key_Down); // dark
  auto* buttons = dialog.findChild<QDialogButtonBox*>();
  QTest::mouseClick(buttons->button(QDialogButtonBox::Apply), Qt::LeftButton);
  EXPECT_EQ(times, 1);
  EXPECT_EQ(told.theme, Theme::Dark);
  QTest::mouseClick(buttons->button(QDialogButtonBox::RestoreDefaults), Qt::LeftButton);
  QTest::keyClick(&dialog, Qt::Key_Escape);
  EXPECT_EQ(times, 1);
  EXPECT_FALSE(dialog.isVisible());
  for (const QComboBox* box : dialog.findChildren<QComboBox*>()) {
    EXPECT_FALSE(box->toolTip().isEmpty());
  }
}
