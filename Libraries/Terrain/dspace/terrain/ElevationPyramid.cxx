#include <dspace/terrain/ElevationPyramid.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <list>
#include <map>
#include <mutex>
#include <optional>
#include <thread>

#include <dspace/Error.h>

namespace dspace {
namespace {

using Clock = std::chrono::steady_clock;
constexpr int Size = ElevationPyramid::TileSize;

// Level, tile column, tile row.
using Key = std::array<std::int64_t, 3>;
using Tile = std::vector<float>; // Size x Size
constexpr std::size_t TileBytes = std::size_t(Size) * Size * sizeof(float);
constexpr std::uint64_t StaleAfter = 1000; // later calls: nobody looks there any more
constexpr double LongestDelay = 30.0;      // [s] between attempts

Clock::duration Seconds(double seconds) {
  return std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
}

std::int64_t FloorDiv(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((-a + b - 1) / b);
}

// A rectangle of a block that lies in one tile.
struct Piece {
  Key key;
  int tileColumn; // of its first post in the tile
  int tileRow;
  int column; // of its first post in the block
  int row;
  int width;
  int height;
};

// The block cut at tile borders and, where the lattice is periodic, at its ends. What lies outside
// the lattice is in no piece.
std::vector<Piece> Cut(const PostLattice& lattice, const PostBlock& block) {
  std::vector<Piece> pieces;
  const std::int64_t columns = lattice.ColumnsAt(block.level);
  const std::int64_t rows = lattice.RowsAt(block.level);
  const std::int64_t top = std::clamp<std::int64_t>(block.row, 0, rows);
  const std::int64_t bottom = std::clamp<std::int64_t>(block.row + block.height, 0, rows);
  std::int64_t left = block.column;
  std::int64_t right = block.column + block.width;
  if (!lattice.periodic) {
    left = std::clamp<std::int64_t>(left, 0, columns);
    right = std::clamp<std::int64_t>(right, 0, columns);
  }
  for (std::int64_t r = top; r < bottom;) {
    const std::int64_t nextRow = std::min((r / Size + 1) * Size, bottom);
    for (std::int64_t c = left; c < right;) {
      const std::int64_t at = c - FloorDiv(c, columns) * columns; // within the lattice
      const std::int64_t end = std::min((at / Size + 1) * Size, columns);
      const std::int64_t run = std::min(end - at, right - c);
      pieces.push_back({{block.level, at / Size, r / Size},
                        int(at % Size),
                        int(r % Size),
                        int(c - block.column),
                        int(r - block.row),
                        int(run),
                        int(nextRow - r)});
      c += run;
    }
    r = nextRow;
  }
  return pieces;
}

} // namespace

struct ElevationPyramid::Implementation {
  struct Resident {
    std::shared_ptr<const Tile> tile;
    std::list<Key>::iterator use; // in `uses`
  };
  struct Request {
    std::uint64_t stamp = 0; // of the latest call that asked for it
    bool reading = false;
    int failures = 0;
    Clock::time_point notBefore = {}; // of the next attempt
    std::exception_ptr error;         // of the last one
  };

  const PostSource& source;
  ElevationPyramidOptions options;
  mutable std::mutex mutex;
  std::condition_variable wanted;  // a worker may have something to do
  std::condition_variable arrived; // a tile came, or an attempt failed
  std::map<Key, Resident> tiles;
  std::list<Key> uses; // latest first
  std::map<Key, Request> requests;
  std::uint64_t stamp = 0;
  std::uint64_t arrivals = 0;
  ElevationPyramidStatistics statistics;
  bool stopping = false;
  std::vector<std::thread> threads;

  Implementation(const PostSource& posts, const ElevationPyramidOptions& given)
      : source(posts), options(given) {
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

  // With the lock held, as all below. Null where the tile is not there.
  std::shared_ptr<const Tile> Find(const Key& key) {
    const auto found = this->tiles.find(key);
    if (found == this->tiles.end()) {
      return nullptr;
    }
    this->uses.splice(this->uses.begin(), this->uses, found->second.use);
    return found->second.tile;
  }

  void Ask(const Key& key) { this->requests[key].stamp = this->stamp; }

  void Store(const Key& key, std::shared_ptr<const Tile> tile) {
    this->uses.push_front(key);
    this->tiles[key] = {std::move(tile), this->uses.begin()};
    this->statistics.bytes += TileBytes;
    ++this->statistics.loads;
    ++this->arrivals;
    while (this->statistics.bytes > this->options.byteBudget) {
      this->tiles.erase(this->uses.back());
      this->uses.pop_back();
      this->statistics.bytes -= TileBytes;
      ++this->statistics.evictions;
    }
  }

  // The request to serve next, or none; `soonest` is then when one becomes due.
  std::map<Key, Request>::iterator Next(std::optional<Clock::time_point>& soonest) {
    const Clock::time_point now = Clock::now();
    auto best = this->requests.end();
    for (auto it = this->requests.begin(); it != this->requests.end();) {
      const Request& request = it->second;
      const bool stale = !request.reading && this->stamp - request.stamp > StaleAfter;
      it = stale ? this->requests.erase(it) : std::next(it);
    }
    for (auto it = this->requests.begin(); it != this->requests.end(); ++it) {
      const Request& request = it->second;
      if (request.reading) {
        continue;
      }
      if (request.notBefore > now) {
        soonest = std::min(soonest.value_or(request.notBefore), request.notBefore);
        continue;
      }
      // The view has moved on from older requests; of one view the coarse levels come first.
      if (best == this->requests.end() || request.stamp > best->second.stamp ||
          (request.stamp == best->second.stamp && it->first[0] > best->first[0])) {
        best = it;
      }
    }
    return best;
  }

  void Work() {
    std::unique_lock<std::mutex> lock(this->mutex);
    while (!this->stopping) {
      std::optional<Clock::time_point> soonest;
      const auto next = this->Next(soonest);
      if (next == this->requests.end()) {
        if (soonest) {
          this->wanted.wait_until(lock, *soonest);
        } else {
          this->wanted.wait(lock);
        }
        continue;
      }
      const Key key = next->first;
      next->second.reading = true;
      lock.unlock();
      std::shared_ptr<Tile> tile;
      std::exception_ptr error;
      try {
        tile = std::make_shared<Tile>(std::size_t(Size) * Size);
        this->source.Read({int(key[0]), key[1] * Size, key[2] * Size, Size, Size}, tile->data());
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      if (error) {
        this->Fail(key, error);
      } else {
        this->requests.erase(key);
        this->Store(key, std::move(tile));
      }
      this->arrived.notify_all();
    }
  }

  void Fail(const Key& key, const std::exception_ptr& error) {
    Request& request = this->requests[key];
    request.reading = false;
    request.error = error;
    const double delay = std::min(
        LongestDelay, std::ldexp(this->options.retryDelay, std::min(request.failures, 20)));
    ++request.failures;
    request.notBefore = Clock::now() + Seconds(delay);
    ++this->statistics.failures;
    try {
      std::rethrow_exception(error);
    } catch (const std::exception& e) {
      this->statistics.lastFailure = e.what();
    } catch (...) {
      this->statistics.lastFailure = "unknown error";
    }
  }

  // Copies what the pieces show, or asks for what is missing and returns false.
  bool Serve(const std::vector<Piece>& pieces, const PostBlock& block, float* heights,
             std::vector<std::shared_ptr<const Tile>>& held) {
    bool complete = true;
    held.resize(pieces.size());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      if (!held[i]) {
        held[i] = this->Find(pieces[i].key);
      }
      if (!held[i]) {
        this->Ask(pieces[i].key);
        complete = false;
      }
    }
    if (!complete) {
      return false;
    }
    std::fill_n(heights, std::size_t(block.width) * block.height,
                std::numeric_limits<float>::quiet_NaN());
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const Piece& piece = pieces[i];
      for (int r = 0; r < piece.height; ++r) {
        std::copy_n(held[i]->data() + std::size_t(piece.tileRow + r) * Size + piece.tileColumn,
                    piece.width, heights + std::size_t(piece.row + r) * block.width + piece.column);
      }
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
                    " bytes is refused; accepted is 4 MiB (4194304) or more");
  }
  if (options.threads < 1 || options.threads > 64) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::to_string(options.threads) + " threads are refused; accepted is 1 to 64");
  }
  if (!(options.retryDelay > 0.0 && options.retryDelay <= LongestDelay) || options.attempts < 1) {
    throw Error(Error::Kind::InvalidArgument, object,
                "a retry delay in (0, 30] s and at least 1 attempt are accepted");
  }
  this->Impl_ = std::make_unique<Implementation>(*this->Source_, options);
}

ElevationPyramid::~ElevationPyramid() = default;

bool ElevationPyramid::TryRead(const PostBlock& block, float* heights) {
  const std::vector<Piece> pieces = Cut(this->Lattice(), block);
  std::vector<std::shared_ptr<const Tile>> held;
  bool complete = false;
  {
    const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
    ++this->Impl_->stamp;
    complete = this->Impl_->Serve(pieces, block, heights, held);
  }
  if (!complete) {
    this->Impl_->wanted.notify_all();
  }
  return complete;
}

void ElevationPyramid::Read(const PostBlock& block, float* heights, double seconds) {
  Implementation& impl = *this->Impl_;
  const std::vector<Piece> pieces = Cut(this->Lattice(), block);
  // Tiles are held as they come: a block larger than the budget is served all the same.
  std::vector<std::shared_ptr<const Tile>> held;
  const bool forever = !(seconds < 1e9);
  const Clock::time_point deadline = Clock::now() + Seconds(forever ? 0.0 : seconds);
  std::unique_lock<std::mutex> lock(impl.mutex);
  ++impl.stamp;
  while (!impl.Serve(pieces, block, heights, held)) {
    for (std::size_t i = 0; i < pieces.size(); ++i) {
      const auto request = impl.requests.find(pieces[i].key);
      if (!held[i] && request != impl.requests.end() &&
          request->second.failures >= impl.options.attempts) {
        const std::exception_ptr error = request->second.error;
        impl.requests.erase(request); // the next reader tries anew
        std::rethrow_exception(error);
      }
    }
    impl.wanted.notify_all();
    if (forever) {
      impl.arrived.wait(lock);
    } else if (impl.arrived.wait_until(lock, deadline) == std::cv_status::timeout) {
      throw Error(Error::Kind::DeadlineExceeded, this->Source_->GetName(),
                  "its tiles were not there within " + std::to_string(seconds) + " s" +
                      (impl.statistics.lastFailure.empty()
                           ? std::string()
                           : "; the last failure: " + impl.statistics.lastFailure));
    }
  }
}

std::uint64_t ElevationPyramid::Arrivals() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->arrivals;
}

ElevationPyramidStatistics ElevationPyramid::Statistics() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  ElevationPyramidStatistics statistics = this->Impl_->statistics;
  statistics.pending = this->Impl_->requests.size();
  return statistics;
}

} // namespace dspace
