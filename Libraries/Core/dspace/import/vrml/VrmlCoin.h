// Coin as a parser: checked text to a graph of Coin's nodes. Internal, not installed.
#ifndef DSPACE_IMPORT_VRML_COIN_H
#define DSPACE_IMPORT_VRML_COIN_H

#include <dspace/import/vrml/text/VrmlGuard.h>

#include <memory>
#include <mutex>
#include <string>
#include <vector>

class SoNode;
class SoSeparator;

namespace dspace {

// Coin's global state belongs to one thread at a time: held for as long as any of its nodes lives.
// While it is held, Coin's messages are collected instead of printed; the handlers that the
// application had set come back at the end.
class CoinSession {
public:
  CoinSession();
  ~CoinSession();
  CoinSession(const CoinSession&) = delete;
  CoinSession& operator=(const CoinSession&) = delete;

  // The messages since the last call.
  std::vector<std::string> TakeMessages();

private:
  struct Handlers;

  std::unique_lock<std::mutex> Lock_;
  std::unique_ptr<Handlers> Handlers_;
};

// A file as Coin sees it.
struct VrmlFile {
  std::string path;
  VrmlDialect dialect = VrmlDialect::Vrml2;
  GuardedVrml guarded; // its text is dropped after parsing
  std::shared_ptr<SoSeparator> root;

  // DEF name of a node in the file, or "".
  std::string NameOf(const SoNode* node) const;
};

// Reads, guards and parses a file; adds to `warnings`. Throws as ReadVrmlText and GuardVrml do, and
// Error(Corrupt) with Coin's words when Coin rejects the text.
VrmlFile ParseVrml(const std::string& path, CoinSession& session,
                   std::vector<std::string>& warnings);

} // namespace dspace

#endif
