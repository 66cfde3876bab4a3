#define PY_SSIZE_T_CLEAN
#include <Python.h> // first, as Python asks

#include <dspace/widgets/console/PythonInterpreter.h>

#include <exception>
#include <map>
#include <stdexcept>

#include <QCoreApplication>
#include <QEventLoop>
#include <QFile>
#include <QTimer>

#include "vtkDspaceSession.h"
#include "vtkPythonUtil.h"

#include <dspace/Error.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/ErrorReply.h>
#include <dspace/widgets/console/PythonAttendant.h>
#include <dspace/widgets/viewport/QtContext.h>

namespace dspace::widgets {
namespace {

constexpr int Breath_ms = 10;

class Lock { // of the interpreter, for a call of Python
public:
  explicit Lock(PythonAttendant* attendant) : Attendant_(attendant), State_(PyGILState_Ensure()) {
    this->Attendant_->Begin();
  }
  Lock(const Lock&) = delete;
  Lock& operator=(const Lock&) = delete;
  ~Lock() {
    this->Attendant_->End();
    PyGILState_Release(this->State_);
    ReleaseOtherContexts(); // scripts may draw with sessions of their own
  }

private:
  PythonAttendant* Attendant_;
  PyGILState_STATE State_;
};

struct Forget {
  void operator()(PyObject* object) const { Py_XDECREF(object); }
};
using Object = std::unique_ptr<PyObject, Forget>;

// The error that is set, in a line; clears it.
std::string TakeError() {
  PyObject* type = nullptr;
  PyObject* value = nullptr;
  PyObject* trace = nullptr;
  PyErr_Fetch(&type, &value, &trace);
  PyErr_NormalizeException(&type, &value, &trace);
  const Object kind(type);
  const Object error(value);
  const Object where(trace);
  const Object text(error ? PyObject_Str(error.get()) : nullptr);
  const char* shown = text ? PyUnicode_AsUTF8(text.get()) : nullptr;
  PyErr_Clear();
  return shown ? shown : "an error without a text";
}

// Before the application's own code, in its name space.
const char* const Start = R"(
import code, rlcompleter, signal, sys
signal.signal(signal.SIGINT, signal.default_int_handler)
import _dspace_host

class _Written:
    encoding = "utf-8"
    def __init__(self, error):
        self._error = error
    def write(self, text):
        _dspace_host.write(text, self._error)
        return len(text)
    def flush(self):
        pass
    def isatty(self):
        return False

sys.stdout, sys.stderr = _Written(False), _Written(True)
sys.argv = [""]
import warnings
warnings.showwarning = lambda message, *_: print(f"note: {message}", file=sys.stderr)
import dspace
import dspace.vtk
from dspace.application import App
app = App(_dspace_host)
app._follow = lambda: _follow()
session, scene, view = app.session, app.scene, None
_current = None
_console = code.InteractiveInterpreter(globals())
_completer = rlcompleter.Completer(globals())

def _follow():
    """`view` is the current view, unless the user has given the name to something else."""
    global view, _current
    if globals().get("view") is _current:
        view = _current = app.view

def _run(source, name):
    import linecache
    _follow()
    linecache.cache[name] = (len(source), None, source.splitlines(True), name)
    try:
        exec(compile(source, name, "exec"), globals())
    except SystemExit as end:
        if end.code not in (None, 0):
            print(end.code, file=sys.stderr)
            return False
    except BaseException:
        _console.showtraceback()
        return False
    return True

def _complete(line):
    word = line[max((line.rfind(c) for c in " \t\n([{,=+-*/:;\"'"), default=-1) + 1:]
    found = []
    if word:
        while len(found) < 200 and (match := _completer.complete(word, len(found))):
            found.append(match)
    return sorted(set(found))
)";

} // namespace

struct PythonInterpreter::Internals {
  PythonInterpreter* interpreter = nullptr;
  vtkDspaceSession* session = nullptr;
  PythonHost host;
  PyObject* names = nullptr; // of __main__; borrowed
  PyThreadState* state = nullptr;
  std::unique_ptr<PythonAttendant> attendant; // while Python runs
  struct Timer {
    std::unique_ptr<QTimer> timer;
    PyObject* callback;
  };
  std::map<long, Timer> timers;
  long lastTimer = 0;

  static Internals* The; // the one of the process

  // Prints the error of a callback.
  void Report() {
    PyErr_Print();
    PyErr_Clear();
  }
  Object Call(const char* function, const Object& arguments) {
    PyObject* callee = PyDict_GetItemString(this->names, function);
    return Object(callee && arguments ? PyObject_CallObject(callee, arguments.get()) : nullptr);
  }

  template<class Function> static PyObject* Guard(const Function& function) {
    try {
      function();
      Py_RETURN_NONE;
    } catch (const Error& error) {
      Raise(error);
      return nullptr;
    } catch (const std::exception& error) {
      PyErr_SetString(PyExc_RuntimeError, error.what());
      return nullptr;
    }
  }
  // As a reply's error is raised (dspace/_core/replies.py).
  static void Raise(const Error& error) {
    const std::string reply =
        session::ErrorReply(session::FromKind(error.GetKind()), error.GetObjectName(), error.what())
            .SerializeAsString();
    const Object module(PyImport_ImportModule("dspace._core.replies"));
    const Object decoded(module ? PyObject_CallMethod(module.get(), "to_reply", "y#", reply.data(),
                                                      Py_ssize_t(reply.size()))
                                : nullptr);
    const Object message(decoded ? PyObject_GetAttrString(decoded.get(), "error") : nullptr);
    const Object raised(
        message ? PyObject_CallMethod(module.get(), "make_error", "O", message.get()) : nullptr);
    if (raised) {
      PyErr_SetObject(reinterpret_cast<PyObject*>(Py_TYPE(raised.get())), raised.get());
    }
  }
  static vtkObject* ShownOf(PyObject* object) {
    return vtkObject::SafeDownCast(vtkPythonUtil::GetPointerFromObject(object, "vtkObject"));
  }

  static PyObject* Write(PyObject*, PyObject* arguments) {
    const char* text = nullptr;
    int error = 0;
    if (!PyArg_ParseTuple(arguments, "sp", &text, &error)) {
      return nullptr;
    }
    return Guard([&] { emit The->interpreter->written(QString::fromUtf8(text), error != 0); });
  }
  static PyObject* Session(PyObject*, PyObject*) {
    return vtkPythonUtil::GetObjectFromPointer(The->session);
  }
  static PyObject* Show(PyObject*, PyObject* arguments) {
    PyObject* session = nullptr;
    const char* name = nullptr;
    const char* title = nullptr;
    if (!PyArg_ParseTuple(arguments, "Oss", &session, &name, &title)) {
      return nullptr;
    }
    vtkObject* of = ShownOf(session);
    return of ? Guard([&] { The->host.show(of, name, title); }) : nullptr;
  }
  static PyObject* Close(PyObject*, PyObject* arguments) {
    PyObject* session = nullptr;
    const char* name = nullptr;
    if (!PyArg_ParseTuple(arguments, "Os", &session, &name)) {
      return nullptr;
    }
    vtkObject* of = ShownOf(session);
    return of ? Guard([&] { The->host.close(of, name); }) : nullptr;
  }
  static PyObject* Follow(PyObject*, PyObject* arguments) {
    PyObject* shown = nullptr;
    const char* title = nullptr;
    if (!PyArg_ParseTuple(arguments, "Os", &shown, &title)) {
      return nullptr;
    }
    vtkObject* of = ShownOf(shown);
    return of ? Guard([&] { The->host.follow(of, title); }) : nullptr;
  }
  static PyObject* ForgetShown(PyObject*, PyObject* arguments) {
    PyObject* shown = nullptr;
    if (!PyArg_ParseTuple(arguments, "O", &shown)) {
      return nullptr;
    }
    vtkObject* of = ShownOf(shown);
    return of ? Guard([&] { The->host.forget(of); }) : nullptr;
  }
  static PyObject* Clock(PyObject*, PyObject* arguments) {
    PyObject* shown = nullptr;
    const char* what = nullptr;
    double a = 0.0;
    double b = 0.0;
    if (!PyArg_ParseTuple(arguments, "Osdd", &shown, &what, &a, &b)) {
      return nullptr;
    }
    vtkObject* of = ShownOf(shown);
    return of ? Guard([&] { The->host.clock(of, what, a, b); }) : nullptr;
  }
  static PyObject* Active(PyObject*, PyObject*) {
    const auto [of, scene] = The->host.active();
    return Py_BuildValue("(Ns)", vtkPythonUtil::GetObjectFromPointer(of), scene.c_str());
  }
  static PyObject* Extend(PyObject*, PyObject* arguments) {
    const char* request = nullptr;
    if (!PyArg_ParseTuple(arguments, "s", &request)) {
      return nullptr;
    }
    std::string answer;
    const Object done(Guard([&] { answer = The->host.extend(request); }));
    return done ? PyUnicode_FromString(answer.c_str()) : nullptr;
  }
  // execute(command): bytes of a Command to bytes of its Reply.
  static PyObject* Execute(PyObject*, PyObject* arguments) {
    const char* bytes = nullptr;
    Py_ssize_t size = 0;
    if (!PyArg_ParseTuple(arguments, "y#", &bytes, &size)) {
      return nullptr;
    }
    const std::string command(bytes, std::size_t(size));
    std::string reply;
    const Object done(Guard([&] {
      PyThreadState* const state = PyEval_SaveThread(); // events may run Python
      std::exception_ptr failed;
      try {
        The->host.readFiles(command);
      } catch (...) {
        failed = std::current_exception();
      }
      PyEval_RestoreThread(state);
      if (failed) {
        std::rethrow_exception(failed);
      }
      reply = The->host.execute(command);
    }));
    return done ? PyBytes_FromStringAndSize(reply.data(), Py_ssize_t(reply.size())) : nullptr;
  }
  // breathe(): lets the windows draw and take events; False: they are closing.
  static PyObject* Breathe(PyObject*, PyObject*) {
    PyThreadState* const state = PyEval_SaveThread(); // events may run Python
    ReleaseOtherContexts();                           // which may have drawn in one of its own
    QCoreApplication::processEvents(QEventLoop::AllEvents, Breath_ms);
    PyEval_RestoreThread(state);
    return PyBool_FromLong(The->host.isOpen());
  }
  static PyObject* Plot(PyObject*, PyObject* arguments) {
    PyObject* shown = nullptr;
    const char* scene = nullptr;
    const char* title = nullptr;
    if (!PyArg_ParseTuple(arguments, "Oss", &shown, &scene, &title)) {
      return nullptr;
    }
    vtkObject* of = ShownOf(shown);
    long number = 0;
    const Object done(of ? Guard([&] { number = The->host.plot(of, scene, title); }) : nullptr);
    return done ? PyLong_FromLong(number) : nullptr;
  }
  static PyObject* PlotChannel(PyObject*, PyObject* arguments) {
    long plot = 0;
    const char* channel = nullptr;
    if (!PyArg_ParseTuple(arguments, "ls", &plot, &channel)) {
      return nullptr;
    }
    return Guard([&] { The->host.plotChannel(plot, channel); });
  }
  // plot_series(plot, name, unit, times, values): bytes of doubles.
  static PyObject* PlotSeries(PyObject*, PyObject* arguments) {
    long plot = 0;
    const char* name = nullptr;
    const char* unit = nullptr;
    Py_buffer times;
    Py_buffer values;
    if (!PyArg_ParseTuple(arguments, "lssy*y*", &plot, &name, &unit, &times, &values)) {
      return nullptr;
    }
    const auto numbers = [](const Py_buffer& buffer) {
      const auto* first = static_cast<const double*>(buffer.buf);
      return std::vector<double>(first, first + std::size_t(buffer.len) / sizeof(double));
    };
    PyObject* done =
        Guard([&] { The->host.plotSeries(plot, name, unit, numbers(times), numbers(values)); });
    PyBuffer_Release(&times);
    PyBuffer_Release(&values);
    return done;
  }
  static PyObject* Message(PyObject*, PyObject* arguments) {
    const char* text = nullptr;
    if (!PyArg_ParseTuple(arguments, "s", &text)) {
      return nullptr;
    }
    return Guard([&] { The->host.message(text); });
  }
  static PyObject* Task(PyObject*, PyObject* arguments) {
    long id = 0;
    const char* text = nullptr;
    double done = 0.0;
    const char* cancel = nullptr;
    if (!PyArg_ParseTuple(arguments, "lsds", &id, &text, &done, &cancel)) {
      return nullptr;
    }
    return Guard([&] { The->host.task(id, text, done, cancel); });
  }
  // every(milliseconds, callback): a number for cancel().
  static PyObject* Every(PyObject*, PyObject* arguments) {
    int milliseconds = 0;
    PyObject* callback = nullptr;
    if (!PyArg_ParseTuple(arguments, "iO", &milliseconds, &callback)) {
      return nullptr;
    }
    Internals& self = *The;
    const long number = ++self.lastTimer;
    Py_INCREF(callback);
    Timer timer{std::make_unique<QTimer>(), callback};
    QObject::connect(timer.timer.get(), &QTimer::timeout, self.interpreter, [number] {
      const Lock lock(The->attendant.get());
      const auto found = The->timers.find(number);
      if (found == The->timers.end()) {
        return;
      }
      const Object kept((Py_INCREF(found->second.callback), found->second.callback));
      const Object result(PyObject_CallNoArgs(kept.get()));
      if (!result) {
        The->Report(); // once, and then it ends
        The->Drop(number);
      }
    });
    timer.timer->start(milliseconds);
    self.timers.emplace(number, std::move(timer));
    return PyLong_FromLong(number);
  }
  void Drop(long number) {
    const auto found = this->timers.find(number);
    if (found != this->timers.end()) {
      found->second.timer->stop();
      found->second.timer.release()->deleteLater(); // it may be what calls
      Py_DECREF(found->second.callback);
      this->timers.erase(found);
    }
  }
  static PyObject* Cancel(PyObject*, PyObject* arguments) {
    long number = 0;
    if (!PyArg_ParseTuple(arguments, "l", &number)) {
      return nullptr;
    }
    return Guard([&] { The->Drop(number); });
  }

  static PyObject* MakeModule() {
    static PyMethodDef methods[] = {{"write", Write, METH_VARARGS, nullptr},
                                    {"session", Session, METH_NOARGS, nullptr},
                                    {"show", Show, METH_VARARGS, nullptr},
                                    {"close", Close, METH_VARARGS, nullptr},
                                    {"forget", ForgetShown, METH_VARARGS, nullptr},
                                    {"clock", Clock, METH_VARARGS, nullptr},
                                    {"follow", Follow, METH_VARARGS, nullptr},
                                    {"task", Task, METH_VARARGS, nullptr},
                                    {"active", Active, METH_NOARGS, nullptr},
                                    {"extend", Extend, METH_VARARGS, nullptr},
                                    {"execute", Execute, METH_VARARGS, nullptr},
                                    {"breathe", Breathe, METH_NOARGS, nullptr},
                                    {"plot", Plot, METH_VARARGS, nullptr},
                                    {"plot_channel", PlotChannel, METH_VARARGS, nullptr},
                                    {"plot_series", PlotSeries, METH_VARARGS, nullptr},
                                    {"message", Message, METH_VARARGS, nullptr},
                                    {"every", Every, METH_VARARGS, nullptr},
                                    {"cancel", Cancel, METH_VARARGS, nullptr},
                                    {nullptr, nullptr, 0, nullptr}};
    static PyModuleDef definition = {PyModuleDef_HEAD_INIT,
                                     "_dspace_host",
                                     nullptr,
                                     -1,
                                     methods,
                                     nullptr,
                                     nullptr,
                                     nullptr,
                                     nullptr};
    return PyModule_Create(&definition);
  }
};

PythonInterpreter::Internals* PythonInterpreter::Internals::The = nullptr;

PythonInterpreter::PythonInterpreter(vtkDspaceSession* session, PythonHost host,
                                     const QString& packages, QObject* parent)
    : QObject(parent), Impl_(std::make_unique<Internals>()) {
  Internals& self = *this->Impl_;
  if (Internals::The) {
    throw std::runtime_error("Python runs in this process already; accepted: one interpreter");
  }
  self.interpreter = this;
  self.session = session;
  self.host = std::move(host);
  Internals::The = &self;
  PyImport_AppendInittab("_dspace_host", &Internals::MakeModule);
  PyConfig config;
  PyConfig_InitPythonConfig(&config);
  config.install_signal_handlers = 0; // the application has its own
  PyConfig_SetString(&config, &config.program_name, L"/usr/bin/python3");
  const PyStatus status = Py_InitializeFromConfig(&config);
  PyConfig_Clear(&config);
  if (PyStatus_Exception(status)) {
    Internals::The = nullptr;
    throw std::runtime_error(std::string("Python does not start: ") +
                             (status.err_msg ? status.err_msg : "no reason given"));
  }
  self.attendant =
      std::make_unique<PythonAttendant>([this](bool busy) { emit this->busyChanged(busy); });
  self.names = PyModule_GetDict(PyImport_AddModule("__main__"));
  std::string error;
  {
    const Object path(PyUnicode_FromString(packages.toUtf8().constData()));
    PyList_Insert(PySys_GetObject("path"), 0, path.get());
    const Object done(PyRun_String(Start, Py_file_input, self.names, self.names));
    if (!done) {
      error = TakeError();
    }
  }
  self.state = PyEval_SaveThread();
  if (!error.empty()) {
    Internals::The = nullptr;
    throw std::runtime_error("Python's package dspace cannot be used from " +
                             packages.toStdString() + ": " + error);
  }
}

PythonInterpreter::~PythonInterpreter() {
  Internals& self = *this->Impl_;
  self.attendant.reset();
  PyEval_RestoreThread(self.state);
  while (!self.timers.empty()) {
    self.Drop(self.timers.begin()->first);
  }
  const Object done(PyRun_String("app.close()", Py_file_input, self.names, self.names));
  if (!done) {
    PyErr_Clear();
  }
  Py_FinalizeEx();
  Internals::The = nullptr;
}

bool PythonInterpreter::Push(const QString& source) {
  const Lock lock(this->Impl_->attendant.get());
  Internals& self = *this->Impl_;
  self.Call("_follow", Object(PyTuple_New(0)));
  PyObject* console = PyDict_GetItemString(self.names, "_console");
  const Object more(
      PyObject_CallMethod(console, "runsource", "ss", source.toUtf8().constData(), "<console>"));
  if (!more) {
    self.Report();
    return false;
  }
  return PyObject_IsTrue(more.get()) == 1;
}

bool PythonInterpreter::Run(const QString& source, const QString& name) {
  const Lock lock(this->Impl_->attendant.get());
  Internals& self = *this->Impl_;
  const Object done = self.Call("_run", Object(Py_BuildValue("(ss)", source.toUtf8().constData(),
                                                             name.toUtf8().constData())));
  if (!done) {
    self.Report();
    return false;
  }
  return PyObject_IsTrue(done.get()) == 1;
}

bool PythonInterpreter::RunFile(const QString& path) {
  QFile file(path);
  if (!file.open(QIODevice::ReadOnly)) {
    emit this->written(path + ": " + file.errorString() + "\n", true);
    return false;
  }
  return this->Run(QString::fromUtf8(file.readAll()), path);
}

QStringList PythonInterpreter::Complete(const QString& line) {
  const Lock lock(this->Impl_->attendant.get());
  Internals& self = *this->Impl_;
  const Object found =
      self.Call("_complete", Object(Py_BuildValue("(s)", line.toUtf8().constData())));
  QStringList names;
  if (!found) {
    PyErr_Clear();
    return names;
  }
  for (Py_ssize_t i = 0; i < PyList_Size(found.get()); ++i) {
    names << QString::fromUtf8(PyUnicode_AsUTF8(PyList_GetItem(found.get(), i)));
  }
  return names;
}

bool PythonInterpreter::IsBusy() const {
  return this->Impl_->attendant->IsBusy();
}

void PythonInterpreter::Interrupt() {
  PyErr_SetInterrupt();
}

void PythonInterpreter::Cancel(long task) {
  const Lock lock(this->Impl_->attendant.get());
  PyObject* app = PyDict_GetItemString(this->Impl_->names, "app");
  const Object told(PyObject_CallMethod(app, "_cancelled", "l", task));
  if (!told) {
    this->Impl_->Report();
  }
}

void PythonInterpreter::Trigger(int action) {
  const Lock lock(this->Impl_->attendant.get());
  const std::string line = "app.plugins.triggered(" + std::to_string(action) + ")";
  const Object done(
      PyRun_String(line.c_str(), Py_file_input, this->Impl_->names, this->Impl_->names));
  if (!done) {
    this->Impl_->Report();
  }
}

void PythonInterpreter::Change(int panel, int row, const std::string& value) {
  const Lock lock(this->Impl_->attendant.get());
  PyObject* app = PyDict_GetItemString(this->Impl_->names, "app");
  const Object json(PyImport_ImportModule("json"));
  const Object given(json ? PyObject_CallMethod(json.get(), "loads", "s", value.c_str()) : nullptr);
  const Object plugIns(PyObject_GetAttrString(app, "plugins"));
  const Object done(given && plugIns ? PyObject_CallMethod(plugIns.get(), "changed", "iiO", panel,
                                                           row, given.get())
                                     : nullptr);
  if (!done) {
    this->Impl_->Report();
  }
}

void PythonInterpreter::Tell(const std::string& viewport, const std::string& event,
                             const std::string& reply) {
  const Lock lock(this->Impl_->attendant.get());
  Internals& self = *this->Impl_;
  PyObject* app = PyDict_GetItemString(self.names, "app");
  const Object told(PyObject_CallMethod(app, "_told", "sy#y#", viewport.c_str(), event.data(),
                                        Py_ssize_t(event.size()), reply.data(),
                                        Py_ssize_t(reply.size())));
  if (!told) {
    self.Report();
  }
}

} // namespace dspace::widgets
