#include <dspace/layers/ColorTiles.h>

#include <algorithm>
#include <condition_variable>
#include <list>
#include <map>
#include <mutex>
#include <thread>
#include <tuple>

#include <dspace/Error.h>
#include <dspace/posts/PostLattice.h>

#include <dspace/layers/LayerTiles.h>
#include <dspace/layers/NormalComposer.h>
#include <dspace/pyramid/TileQueue.h>

namespace dspace {
namespace {

constexpr std::uint64_t StaleAfter = 120; // later calls
constexpr std::size_t Overhead = 256;     // bytes, of a tile without texels: they are bounded, too

// A tile of a composition, by the composition's number.
using Composed = std::pair<int, ColorTile>;

struct Nothing {};
using Queue = TileQueue<Composed, Nothing>;

// A layer's own tile (composition 0), or with no layer a composed one.
using Key = std::pair<const ColorLayer*, Composed>;

struct Resident {
  std::shared_ptr<const ColorLayer> layer; // keeps its address from being another's
  ColorTiles::TilePointer tile;            // of a layer: its texels as they are, no revision
  std::list<Key>::iterator use;
  std::size_t Bytes() const { return Overhead + this->tile->texels.size(); }
};

using Parts = std::vector<std::pair<ColorTiles::TilePointer, double>>; // with their opacities

template<class Composer> std::vector<std::uint8_t> ComposedBy(const Parts& parts) {
  Composer composer;
  for (const auto& [tile, opacity] : parts) {
    composer.Add(tile->texels, opacity);
  }
  return composer.Encode();
}

struct Snapshot {
  std::uint64_t revision = 0;
  std::vector<StackedLayer> layers;
};

} // namespace

struct ColorTiles::Implementation {
  std::shared_ptr<const LayerStack> stack;
  std::vector<ColorGrid> grids;
  ColorTilesOptions options;
  mutable std::mutex mutex;
  std::condition_variable wanted;                          // a worker may have something to do
  std::condition_variable arrived;                         // a tile came, or an attempt failed
  std::vector<LayerChoice> compositions = {LayerChoice()}; // by number
  std::map<LayerChoice, int> numbers = {{LayerChoice(), 0}};
  std::map<Key, Resident> tiles;
  std::list<Key> uses; // latest first
  Queue queue;
  Snapshot latest; // what the workers saw last
  std::uint64_t arrivals = 0;
  ColorTilesStatistics statistics;
  bool stopping = false;
  std::vector<std::thread> threads;

  Implementation(std::shared_ptr<const LayerStack> layers, std::vector<ColorGrid> charts,
                 const ColorTilesOptions& given)
      : stack(std::move(layers)), grids(std::move(charts)), options(given),
        queue(StaleAfter, given.retryDelay) {
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

  // Throws for a chart or zoom that is none; columns in the first turn.
  std::vector<ColorTile> Checked(const std::vector<ColorTile>& asked) const {
    std::vector<ColorTile> tiles = asked;
    for (ColorTile& tile : tiles) {
      if (tile.chart < 0 || std::size_t(tile.chart) >= this->grids.size() || tile.zoom < 0 ||
          tile.zoom > ColorGrid::MaximumZoom) {
        throw Error(Error::Kind::InvalidArgument, "colour tiles",
                    "chart " + std::to_string(tile.chart) + ", zoom " + std::to_string(tile.zoom) +
                        " asked for; accepted are charts 0 to " +
                        std::to_string(this->grids.size() - 1) + ", zooms 0 to " +
                        std::to_string(ColorGrid::MaximumZoom));
      }
      const ColorGrid& grid = this->grids[std::size_t(tile.chart)];
      if (grid.periodic) {
        const std::int64_t around = grid.ColumnsAt(tile.zoom);
        tile.column -= FloorDiv(tile.column, around) * around;
      }
    }
    return tiles;
  }

  // With the lock held, as all below.
  TilePointer Find(const ColorLayer* layer, const Composed& tile) {
    const auto found = this->tiles.find({layer, tile});
    if (found == this->tiles.end()) {
      return nullptr;
    }
    this->uses.splice(this->uses.begin(), this->uses, found->second.use);
    return found->second.tile;
  }

  std::map<Key, Resident>::iterator Evict(std::map<Key, Resident>::iterator found) {
    this->statistics.bytes -= found->second.Bytes();
    this->uses.erase(found->second.use);
    return this->tiles.erase(found);
  }

  void Store(const std::shared_ptr<const ColorLayer>& layer, const Composed& at, TilePointer tile) {
    const Key key(layer.get(), at);
    const auto old = this->tiles.find(key);
    if (old != this->tiles.end()) {
      this->Evict(old);
    }
    this->uses.push_front(key);
    const Resident& resident = this->tiles[key] =
        Resident{layer, std::move(tile), this->uses.begin()};
    this->statistics.bytes += resident.Bytes();
    while (this->statistics.bytes > this->options.byteBudget) {
      this->Evict(this->tiles.find(this->uses.back()));
    }
  }

  bool IsInLatest(const std::shared_ptr<const ColorLayer>& layer) const {
    return std::any_of(this->latest.layers.begin(), this->latest.layers.end(),
                       [&](const StackedLayer& each) { return each.layer == layer; });
  }

  // Tiles of layers that were taken away are let go.
  void TakeStack() {
    if (this->latest.revision == this->stack->Revision()) {
      return;
    }
    this->latest.layers = this->stack->Layers(&this->latest.revision);
    for (auto it = this->tiles.begin(); it != this->tiles.end();) {
      const bool gone = it->second.layer && !this->IsInLatest(it->second.layer);
      it = gone ? this->Evict(it) : std::next(it);
    }
  }

  void Work() {
    std::unique_lock<std::mutex> lock(this->mutex);
    while (true) {
      const auto next = this->queue.Wait(lock, this->wanted, this->stopping);
      if (this->queue.IsNone(next)) {
        return;
      }
      const Composed at = next->first;
      next->second.reading = true;
      try {
        TilePointer tile = this->Compose(lock, at);
        this->queue.Done(at);
        this->Store(nullptr, at, std::move(tile));
        ++this->arrivals;
      } catch (...) {
        this->statistics.lastFailure = this->queue.Fail(at, std::current_exception());
        ++this->statistics.failures;
      }
      this->arrived.notify_all();
    }
  }

  // Lets the lock go while it reads and composes; holds it when it returns or throws.
  TilePointer Compose(std::unique_lock<std::mutex>& lock, const Composed& wanted) {
    this->TakeStack();
    Snapshot snapshot = this->latest;
    const LayerChoice choice = this->compositions[std::size_t(wanted.first)];
    const ColorTile& at = wanted.second;
    std::stable_partition(snapshot.layers.begin(), snapshot.layers.end(),
                          [](const StackedLayer& layer) { return !layer.mark; });
    const ColorGrid& grid = this->grids[std::size_t(at.chart)];
    auto composed = std::make_shared<Tile>();
    composed->revision = snapshot.revision;
    Parts parts;
    for (const StackedLayer& layer : snapshot.layers) {
      if (!choice.Takes(layer) || !HasGround(grid, at)) {
        continue;
      }
      TilePointer own = this->Find(layer.layer.get(), {0, at});
      if (!own) {
        auto read = std::make_shared<Tile>();
        Unlocked(lock, [&] { read->texels = ReadLayerTile(*layer.layer, grid, at); });
        ++this->statistics.reads;
        own = std::move(read);
        if (this->IsInLatest(layer.layer)) { // it may have been removed since
          this->Store(layer.layer, {0, at}, own);
        }
      }
      if (!own->texels.empty()) {
        parts.emplace_back(std::move(own), layer.opacity);
      }
    }
    Unlocked(lock, [&] {
      composed->texels = choice.part == LayerChoice::Part::Normals
                             ? ComposedBy<NormalComposer>(parts)
                             : ComposedBy<TileComposer>(parts);
    });
    ++this->statistics.compositions;
    return composed;
  }

  template<class F> static void Unlocked(std::unique_lock<std::mutex>& lock, F&& work) {
    lock.unlock();
    try {
      work();
    } catch (...) {
      lock.lock();
      throw;
    }
    lock.lock();
  }

  static std::vector<Composed> Of(int composition, const std::vector<ColorTile>& tiles) {
    std::vector<Composed> composed;
    composed.reserve(tiles.size());
    for (const ColorTile& tile : tiles) {
      composed.emplace_back(composition, tile);
    }
    return composed;
  }

  // What is there, of `revision` or later, joins what is held; false, and the rest asked for, where
  // not all is. Older ones are held as well where `old` says so.
  bool Serve(const std::vector<Composed>& asked, std::uint64_t revision, bool old,
             std::vector<TilePointer>& held) {
    bool complete = true;
    held.resize(asked.size());
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (held[i] && held[i]->revision >= revision) {
        continue;
      }
      TilePointer tile = this->Find(nullptr, asked[i]);
      const bool current = tile && tile->revision >= revision;
      if (current || old) {
        held[i] = std::move(tile);
      }
      if (!current) {
        this->queue.Add(asked[i], std::int64_t(i));
        complete = false;
      }
    }
    return complete;
  }
};

ColorTiles::ColorTiles(std::shared_ptr<const LayerStack> stack, std::vector<ColorGrid> grids,
                       const ColorTilesOptions& options) {
  const auto reject = [](const std::string& message) {
    throw Error(Error::Kind::InvalidArgument, "colour tiles", message);
  };
  if (!stack || grids.empty()) {
    reject("a stack and at least one grid are needed");
  }
  if (options.byteBudget < (std::size_t(16) << 20)) {
    reject("a budget of " + std::to_string(options.byteBudget) +
           " bytes is rejected; accepted is 16 MiB (16777216) or more");
  }
  if (options.threads < 1 || options.threads > 64) {
    reject(std::to_string(options.threads) + " threads are rejected; accepted is 1 to 64");
  }
  if (!(options.retryDelay > 0.0 && options.retryDelay <= Queue::LongestDelay) ||
      options.attempts < 1) {
    reject("a retry delay in (0, 30] s and at least 1 attempt are accepted");
  }
  this->Impl_ = std::make_unique<Implementation>(std::move(stack), std::move(grids), options);
}

ColorTiles::~ColorTiles() = default;

const LayerStack& ColorTiles::Stack() const {
  return *this->Impl_->stack;
}

const std::vector<ColorGrid>& ColorTiles::Grids() const {
  return this->Impl_->grids;
}

int ColorTiles::CompositionOf(const LayerChoice& choice) {
  Implementation& impl = *this->Impl_;
  const LayerChoice reduced = impl.stack->Reduced(choice);
  const std::lock_guard<std::mutex> lock(impl.mutex);
  const auto number = impl.numbers.emplace(reduced, int(impl.compositions.size()));
  if (number.second) {
    impl.compositions.push_back(reduced);
  }
  return number.first->second;
}

std::vector<ColorTiles::TilePointer> ColorTiles::TryGet(const std::vector<ColorTile>& tiles,
                                                        int composition) {
  Implementation& impl = *this->Impl_;
  const std::vector<Composed> asked = Implementation::Of(composition, impl.Checked(tiles));
  std::vector<TilePointer> held;
  {
    const std::lock_guard<std::mutex> lock(impl.mutex);
    impl.queue.BeginCall();
    if (impl.Serve(asked, impl.stack->Revision(), true, held)) {
      impl.queue.CancelCall();
      return held;
    }
  }
  impl.wanted.notify_all();
  return held;
}

std::vector<ColorTiles::TilePointer> ColorTiles::Get(const std::vector<ColorTile>& tiles,
                                                     double seconds, int composition) {
  Implementation& impl = *this->Impl_;
  const std::vector<Composed> asked = Implementation::Of(composition, impl.Checked(tiles));
  // Tiles are held as they come: more of them than the budget has room for are served all the same.
  std::vector<TilePointer> held;
  const bool forever = !(seconds < 1e9);
  const auto deadline = Queue::Clock::now() + Queue::Seconds(forever ? 0.0 : seconds);
  std::unique_lock<std::mutex> lock(impl.mutex);
  const std::uint64_t revision = impl.stack->Revision();
  impl.queue.BeginCall();
  if (impl.Serve(asked, revision, false, held)) {
    impl.queue.CancelCall();
    return held;
  }
  Queue::Waiting waiting(impl.queue, asked);
  bool late = false;
  do {
    if (late) {
      throw Error(Error::Kind::DeadlineExceeded, "colour tiles",
                  "they were not loaded within " + std::to_string(seconds) + " s" +
                      (impl.statistics.lastFailure.empty()
                           ? std::string()
                           : "; the last failure: " + impl.statistics.lastFailure));
    }
    for (std::size_t i = 0; i < asked.size(); ++i) {
      if (!held[i]) {
        waiting.Check(asked[i], impl.options.attempts);
      }
    }
    impl.wanted.notify_all();
    if (forever) {
      impl.arrived.wait(lock);
    } else {
      late = impl.arrived.wait_until(lock, deadline) == std::cv_status::timeout;
    }
  } while (!impl.Serve(asked, revision, false, held));
  return held;
}

std::uint64_t ColorTiles::Arrivals() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  this->Impl_->TakeStack(); // required after removal of the last layer
  return this->Impl_->arrivals + this->Impl_->stack->Revision();
}

ColorTilesStatistics ColorTiles::Statistics() const {
  std::size_t kept = 0;
  for (const StackedLayer& stacked : this->Stack().Layers()) {
    kept += stacked.layer->KeptBytes();
  }
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  ColorTilesStatistics statistics = this->Impl_->statistics;
  statistics.keptBytes = kept;
  statistics.pending = this->Impl_->queue.Count();
  return statistics;
}

} // namespace dspace
