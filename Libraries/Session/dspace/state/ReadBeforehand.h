// What a command reads, read in another thread before the command is executed.
#ifndef DSPACE_SESSION_READ_BEFOREHAND_H
#define DSPACE_SESSION_READ_BEFOREHAND_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/state/ModelCache.h>

namespace dspace::session {

struct OpenedLayer;
class TerrainObject;

// Filled by ReadFiles (commands/beforehand) in any one thread, then used by one command in the
// session's thread: models of the cache and a terrain that are in it are not read again.
struct ReadBeforehand {
  ReadBeforehand();
  ~ReadBeforehand();
  ReadBeforehand(const ReadBeforehand&) = delete;
  ReadBeforehand& operator=(const ReadBeforehand&) = delete;

  ModelCache models;
  std::vector<std::shared_ptr<const Model>> kept; // of the cache

  std::string askedTerrain;               // the command, serialized, and the name that it gets
  std::unique_ptr<TerrainObject> terrain; // null: none was read
  std::string openedTerrain;              // the command as recorded, without ids
  std::vector<std::string> warnings;      // of the terrain
  FilesRead files;                        // likewise, or of the layer

  std::string askedLayer;             // the command that adds a layer to a terrain, serialized
  std::shared_ptr<OpenedLayer> layer; // null: none was read

  // What the commands of this thread may use; null: nothing.
  static ReadBeforehand* Current();
  // During its lifetime `read` is Current() of this thread.
  class Scope {
  public:
    explicit Scope(ReadBeforehand* read);
    ~Scope();
    Scope(const Scope&) = delete;
    Scope& operator=(const Scope&) = delete;

  private:
    ReadBeforehand* Outer_;
  };
};

} // namespace dspace::session

#endif
