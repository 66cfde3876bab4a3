// The application's window in a test: one for all cases of a suite, as a process has one
// interpreter.
#ifndef DSPACE_TEST_WINDOW_FIXTURE_H
#define DSPACE_TEST_WINDOW_FIXTURE_H

#include <functional>
#include <string>

#include <QStandardPaths>
#include <QTemporaryDir>
#include <QtTest>
#include <gtest/gtest.h>

#include <dspace/widgets/console/PythonInterpreter.h>
#include <dspace/widgets/window/MainWindow.h>

class WindowFixture : public ::testing::Test {
protected:
  static void SetUpTestSuite() {
    QStandardPaths::setTestModeEnabled(true); // not the user's settings
    window = new dspace::widgets::MainWindow(QStringLiteral(DSPACE_PACKAGES));
    window->resize(1000, 760);
    window->show();
    folder = new QTemporaryDir;
    QObject::connect(window->Interpreter(), &dspace::widgets::PythonInterpreter::written, window,
                     [](const QString& text, bool error) { (error ? errors : printed) += text; });
  }
  static void TearDownTestSuite() {
    delete window;
    window = nullptr;
    delete folder;
    folder = nullptr;
  }
  void SetUp() override {
    printed.clear();
    errors.clear();
  }

  static bool Run(const QString& python) { return window->Run(python); }
  // What an expression of Python is, as text.
  static std::string Value(const QString& expression) {
    printed.clear();
    window->Interpreter()->Run("print(" + expression + ")");
    return printed.trimmed().toStdString();
  }
  static double Number(const QString& expression) {
    return QString::fromStdString(Value(expression)).toDouble();
  }
  static bool Wait(const std::function<bool()>& until, int milliseconds = 20000) {
    return QTest::qWaitFor(until, milliseconds);
  }
  static bool Settled() {
    return Wait([] { return window->IsSettled(); });
  }

  inline static dspace::widgets::MainWindow* window = nullptr;
  inline static QTemporaryDir* folder = nullptr;
  inline static QString printed;
  inline static QString errors;
};

#endif
