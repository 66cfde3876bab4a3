#include <dspace/import/vrml/VrmlCoin.h>

#include <dspace/import/files/ImportFile.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>

#include <Inventor/SoDB.h>
#include <Inventor/SoInput.h>
#include <Inventor/VRMLnodes/SoVRMLInline.h>
#include <Inventor/errors/SoDebugError.h>
#include <Inventor/errors/SoErrors.h>
#include <Inventor/errors/SoReadError.h>
#include <Inventor/nodes/SoSeparator.h>
#include <Inventor/nodes/SoWWWInline.h>

#include <cctype>

namespace dspace {

namespace {

std::mutex& CoinMutex() {
  static std::mutex mutex;
  return mutex;
}

void Collect(const SoError* error, void* messages) {
  auto& list = *static_cast<std::vector<std::string>*>(messages);
  if (list.size() < 100) {
    list.emplace_back(error->getDebugString().getString());
  }
}

void FetchNothing(const SbString& /*url*/, void* /*closure*/, SoVRMLInline* /*node*/) {}

// Coin's "Coin read error: ...\n\tOccurred at line   7 in ..." on one line.
std::string OneLine(const std::string& message) {
  std::string line;
  for (const char c : message) {
    const bool space = std::isspace(static_cast<unsigned char>(c)) != 0;
    if (!space || (!line.empty() && line.back() != ' ')) {
      line.push_back(space ? ' ' : c);
    }
  }
  return Utf8Beginning(line, 300);
}

} // namespace

struct CoinSession::Handlers {
  std::vector<std::string> messages;
  SoErrorCB* error = nullptr;
  void* errorData = nullptr;
  SoErrorCB* read = nullptr;
  void* readData = nullptr;
  SoErrorCB* debug = nullptr;
  void* debugData = nullptr;
};

CoinSession::CoinSession() : Lock_(CoinMutex()), Handlers_(std::make_unique<Handlers>()) {
  if (!SoDB::isInitialized()) {
    SoDB::init();
  }
  Handlers& h = *this->Handlers_;
  h.error = SoError::getHandlerCallback();
  h.errorData = SoError::getHandlerData();
  h.read = SoReadError::getHandlerCallback();
  h.readData = SoReadError::getHandlerData();
  h.debug = SoDebugError::getHandlerCallback();
  h.debugData = SoDebugError::getHandlerData();
  SoError::setHandlerCallback(Collect, &h.messages);
  SoReadError::setHandlerCallback(Collect, &h.messages);
  SoDebugError::setHandlerCallback(Collect, &h.messages);
  // Coin opens no file on its own: the importer follows what Inline and textures name.
  SoVRMLInline::setReadAsSoFile(FALSE);
  SoVRMLInline::setFetchURLCallBack(FetchNothing, nullptr);
  SoWWWInline::setReadAsSoFile(FALSE);
}

CoinSession::~CoinSession() {
  const Handlers& h = *this->Handlers_;
  SoError::setHandlerCallback(h.error, h.errorData);
  SoReadError::setHandlerCallback(h.read, h.readData);
  SoDebugError::setHandlerCallback(h.debug, h.debugData);
}

std::vector<std::string> CoinSession::TakeMessages() {
  std::vector<std::string> messages;
  messages.swap(this->Handlers_->messages);
  return messages;
}

std::string VrmlFile::NameOf(const SoNode* node) const {
  const auto found = this->guarded.names.find(node->getName().getString());
  return found == this->guarded.names.end() ? "" : found->second;
}

VrmlFile ParseVrml(const std::string& path, CoinSession& session,
                   std::vector<std::string>& warnings) {
  VrmlFile file;
  file.path = path;
  {
    const VrmlText text = ReadVrmlText(path);
    file.dialect = text.dialect;
    file.guarded = GuardVrml(text, path, warnings);
  }
  session.TakeMessages();
  SoInput input;
  input.setBuffer(file.guarded.text.data(), file.guarded.text.size());
  SoSeparator* root = SoDB::readAll(&input);
  const std::vector<std::string> messages = session.TakeMessages();
  if (!root) {
    throw Error(Error::Kind::Corrupt, FileObject(path),
                messages.empty() ? "cannot be parsed" : OneLine(messages.front()));
  }
  root->ref();
  file.root = std::shared_ptr<SoSeparator>(root, [](SoSeparator* node) { node->unref(); });
  for (const std::string& message : messages) {
    warnings.push_back(OneLine(message) + " (" + FileObject(path) + ")");
  }
  std::string().swap(file.guarded.text);
  return file;
}

} // namespace dspace
