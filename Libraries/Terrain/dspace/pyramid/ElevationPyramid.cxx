#include <dspace/pyramid/ElevationPyramid.h>

#include <algorithm>
#include <atomic>
#include <condition_variable>
#include <cstdio>
#include <exception>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <dspace/Error.h>

#include <dspace/pyramid/PyramidTiles.h>
#include <dspace/pyramid/TileQueue.h>

namespace dspace {
namespace {

constexpr std::uint64_t StaleAfter = 1000; // later calls

struct SinceRead {
  TileBox since; // what changed while it is being read
};
using Queue = TileQueue<TileKey, SinceRead>;

// A caller that has used up its time elsewhere has none left to name.
std::string WithinSeconds(double seconds) {
  if (!(seconds > 0.0)) {
    return "its tiles were not loaded before the deadline";
  }
  char number[32];
  std::snprintf(number, sizeof number, "%g", seconds);
  return "its tiles were not loaded within " + std::string(number) + " s";
}

} // namespace

struct ElevationPyramid::Implementation {
  struct Resident {
    std::shared_ptr<const PyramidTile> tile;
    std::list<TileKey>::iterator use; // in `uses`
    TileBox stale;                    // has changed since
  };
  const PostSource& source;
  ElevationPyramidOptions options;
  mutable std::mutex mutex;
  std::condition_variable wanted;  // a worker may have something to do
  std::condition_variable arrived; // a tile came, or an attempt failed
  std::map<TileKey, Resident> tiles;
  std::list<TileKey> uses; // latest first
  Queue queue;
  std::uint64_t arrivals = 0;
  PyramidChangeLog changes;
  std::atomic<std::uint64_t> changed{0}; // stamp of the latest change, for who does not lock
  ElevationPyramidStatistics statistics;
  bool stopping = false;
  std::vector<std::thread> threads;

  Implementation(const PostSource& posts, const ElevationPyramidOptions& given)
      : source(posts), options(given), queue(StaleAfter, given.retryDelay) {
    for (int i = 0; i < given.threads; ++i) {
      this->threads.emplace_back([this] { this->Work(); });
    }
  }

  ~Implementation() {
    {
      const std::lock_guard<std::mutex> lock(this->mutex);
      this->stopping = true;
    }
    this->wanted.notify_all();
    for (std::thread& thread : this->threads) {
      thread.join();
    }
  }

  // With the lock held, as all below. Null where the tile is not there, or has changed in the
  // piece.
  std::shared_ptr<const PyramidTile> Find(const TilePiece& piece) {
    const auto found = this->tiles.find(piece.key);
    if (found == this->tiles.end() || found->second.stale.Meets(piece.box)) {
      return nullptr;
    }
    this->uses.splice(this->uses.begin(), this->uses, found->second.use);
    return found->second.tile;
  }

  // Of one view the coarse levels come first.
  void RequestTile(const TileKey& key) { this->queue.Add(key, -key[0]); }

  void Evict(std::map<TileKey, Resident>::iterator found) {
    this->statistics.bytes -= found->second.tile->Bytes();
    this->uses.erase(found->second.use);
    this->tiles.erase(found);
  }

  void Store(const TileKey& key, std::shared_ptr<const PyramidTile> tile, const TileBox& stale) {
    const auto old = this->tiles.find(key);
    if (old != this->tiles.end()) {
      this->Evict(old);
    }
    this->statistics.bytes += tile->Bytes();
    this->uses.push_front(key);
    this->tiles[key] = {std::move(tile), this->uses.begin(), stale};
    ++this->arrivals;
    while (this->statistics.bytes > this->options.byteBudget) {
      this->Evict(this->tiles.find(this->uses.back()));
      ++this->statistics.evictions;
    }
  }

  void Invalidate(const std::vector<PostRectangle>& rectangles) {
    const PostLattice& lattice = this->source.GetLattice();
    for (const PostRectangle& rectangle : rectangles) {
      this->changes.Add(rectangle);
      std::vector<PostRectangle> posts;
      for (int level = 0; level < std::min(lattice.levels, rectangle.levels); ++level) {
        posts.push_back(level < rectangle.from ? PostRectangle() : PostsTouched(rectangle, level));
      }
      const auto touched = [&](const TileKey& key) {
        return key[0] < std::int64_t(posts.size()) ? TouchedOfTile(lattice, posts[key[0]], key)
                                                   : TileBox();
      };
      for (auto& [key, resident] : this->tiles) {
        resident.stale.Widen(touched(key));
      }
      for (auto& [key, request] : this->queue.All()) {
        request.since.Widen(touched(key));
      }
    }
    this->changed = this->changes.Latest();
    ++this->arrivals;
  }

  void Work() {
    std::unique_lock<std::mutex> lock(this->mutex);
    while (true) {
      const auto next = this->queue.Wait(lock, this->wanted, this->stopping);
      if (this->queue.IsNone(next)) {
        return;
      }
      const TileKey key = next->first;
      next->second.reading = true;
      next->second.since = {};
      const auto resident = this->tiles.find(key);
      const bool patch = resident != this->tiles.end();
      const std::shared_ptr<const PyramidTile> old = patch ? resident->second.tile : nullptr;
      const TileBox box =
          patch ? resident->second.stale : TileBox{0, 0, PyramidTileSize, PyramidTileSize};
      lock.unlock();
      std::shared_ptr<const PyramidTile> tile;
      std::exception_ptr error;
      try {
        tile = box.Empty() ? old : ReadPyramidTile(this->source, key, box, old.get());
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error) {
        this->statistics.lastFailure = this->queue.Fail(key, error);
        ++this->statistics.failures;
      } else {
        const TileBox since = this->queue.Find(key)->since;
        this->queue.Done(key);
        this->Store(key, std::move(tile), since);
        ++(patch ? this->statistics.patches : this->statistics.loads);
      }
      this->arrived.notify_all();
    }
  }

  // Copies what the pieces show, or asks for what is missing (if `ask`) and returns false.
  bool Serve(const std::vector<TilePiece>& pieces, const PostBlock& block, const PostPlanes& planes,
             std::vector<std::shared_ptr<const PyramidTile>>& held, bool ask = true) {
    bool complete = true;
    held.resize(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (!held[i]) {
        held[i] = this->Find(pieces[i]);
      }
      if (!held[i]) {
        if (ask) {
          this->RequestTile(pieces[i].key);
        }
        complete = false;
      }
    }
    if (!complete) {
      return false;
    }
    const std::size_t posts = std::size_t(block.width) * block.height;
    std::fill_n(planes.heights, posts, std::numeric_limits<float>::quiet_NaN());
    if (planes.tracks) {
      std::fill_n(planes.tracks, posts, 0.0f);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      CopyPiece(*held[i], pieces[i], block.width, planes);
    }
    return true;
  }
};

ElevationPyramid::ElevationPyramid(std::shared_ptr<const PostSource> source,
                                   const ElevationPyramidOptions& options)
    : Source_(std::move(source)) {
  const std::string object = "pyramid of " + this->Source_->GetName();
  if (options.byteBudget < (std::size_t(4) << 20)) {
    throw Error(Error::Kind::InvalidArgument, object,
                "a budget of " + std::to_string(options.byteBudget) +
                    " bytes is rejected; accepted is 4 MiB (4194304) or more");
  }
  if (options.threads < 1 || options.threads > 64) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(options.threads) + " threads are rejected; accepted is 1 to 64");
  }
  if (!(options.retryDelay > 0.0 && options.retryDelay <= Queue::LongestDelay) ||
      options.attempts < 1) {
    throw Error(Error::Kind::InvalidArgument, object,
                "a retry delay in (0, 30] s and at least 1 attempt are accepted");
  }
  this->Impl_ = std::make_unique<Implementation>(*this->Source_, options);
}

ElevationPyramid::~ElevationPyramid() = default;

bool ElevationPyramid::TryRead(const PostBlock& block, float* heights) {
  return this->TryRead(block, heights, nullptr);
}

bool ElevationPyramid::TryRead(const PostBlock& block, float* heights, float* tracks) {
  const std::vector<TilePiece> pieces = CutIntoTiles(this->Lattice(), block);
  std::vector<std::shared_ptr<const PyramidTile>> held;
  bool complete = false;
  {
    const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
    this->Impl_->queue.BeginCall();
    complete = this->Impl_->Serve(pieces, block, {heights, tracks}, held);
    if (complete) {
      this->Impl_->queue.CancelCall();
    }
  }
  if (!complete) {
    this->Impl_->wanted.notify_all();
  }
  return complete;
}

bool ElevationPyramid::ReadHeld(const PostBlock& block, float* heights) {
  const std::vector<TilePiece> pieces = CutIntoTiles(this->Lattice(), block);
  std::vector<std::shared_ptr<const PyramidTile>> held;
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->Serve(pieces, block, {heights, nullptr}, held, false);
}

void ElevationPyramid::Read(const PostBlock& block, float* heights, double seconds) {
  this->Read(block, heights, nullptr, seconds);
}

void ElevationPyramid::Read(const PostBlock& block, float* heights, float* tracks, double seconds) {
  Implementation& impl = *this->Impl_;
  const std::vector<TilePiece> pieces = CutIntoTiles(this->Lattice(), block);
  // Tiles are held as they come: a block larger than the budget is served all the same.
  std::vector<std::shared_ptr<const PyramidTile>> held;
  const bool forever = !(seconds < 1e9);
  const auto deadline = Queue::Clock::now() + Queue::Seconds(forever ? 0.0 : seconds);
  std::unique_lock<std::mutex> lock(impl.mutex);
  impl.queue.BeginCall();
  if (impl.Serve(pieces, block, {heights, tracks}, held)) {
    impl.queue.CancelCall();
    return;
  }
  std::vector<TileKey> keys;
  for (const TilePiece& piece : pieces) {
    keys.push_back(piece.key);
  }
  Queue::Waiting waiting(impl.queue, std::move(keys));
  do {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (!held[i]) {
        waiting.Check(pieces[i].key, impl.options.attempts);
      }
    }
    impl.wanted.notify_all();
    if (forever) {
      impl.arrived.wait(lock);
    } else if (impl.arrived.wait_until(lock, deadline) == std::cv_status::timeout) {
      throw Error(Error::Kind::DeadlineExceeded, this->Source_->GetName(),
                  WithinSeconds(seconds) +
                      (impl.statistics.lastFailure.empty()
                           ? std::string()
                           : "; the last failure: " + impl.statistics.lastFailure));
    }
  } while (!impl.Serve(pieces, block, {heights, tracks}, held));
}

void ElevationPyramid::Invalidate(const std::vector<PostRectangle>& rectangles) {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  this->Impl_->Invalidate(rectangles);
}

PyramidChanges ElevationPyramid::Changes(std::uint64_t since) const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->changes.Since(since, this->Lattice());
}

std::uint64_t ElevationPyramid::LatestChange() const {
  return this->Impl_->changed;
}

std::uint64_t ElevationPyramid::Arrivals() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->arrivals;
}

ElevationPyramidStatistics ElevationPyramid::Statistics() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  ElevationPyramidStatistics statistics = this->Impl_->statistics;
  statistics.pending = this->Impl_->queue.Count();
  return statistics;
}

} // namespace dspace
