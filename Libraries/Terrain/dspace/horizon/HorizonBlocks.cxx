#include <dspace/horizon/HorizonBlocks.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <exception>
#include <map>
#include <mutex>
#include <set>
#include <string>
#include <thread>
#include <utility>

#include <dspace/Error.h>

namespace dspace {
namespace {

using Clock = std::chrono::steady_clock;

constexpr double ReadSeconds = 600.0; // of one sweep; the pyramid reports errors long before
constexpr double RestSeconds = 0.5;   // between two sweeps of a block whose posts keep changing
constexpr double RetrySeconds = 1.0;  // after a sweep that failed

bool Touches(const PostLattice& lattice, const PostRectangle& base, const PostBlock& read) {
  if (read.level < base.from || read.level >= base.levels) {
    return false;
  }
  const PostRectangle posts = PostsTouched(base, read.level);
  if (posts.row >= read.row + read.height || posts.row + posts.height <= read.row) {
    return false;
  }
  std::int64_t column = posts.column;
  if (lattice.periodic) { // the first turn that ends behind the block's begin
    const std::int64_t around = lattice.ColumnsAt(read.level);
    column -= FloorDiv(column + posts.width - 1 - read.column, around) * around;
  }
  return column < read.column + read.width && column + posts.width > read.column;
}

} // namespace

struct HorizonBlocks::Implementation {
  struct Held {
    Pointer block;
    std::vector<PostBlock> read;
    Clock::time_point swept;
    std::uint64_t use = 0;
    bool outdated = false;
  };
  struct Request {
    std::uint64_t call = 0;
    std::size_t rank = 0; // within the call: the least comes first
    Clock::time_point notBefore = {};
    bool running = false;
  };
  struct Failure {
    std::exception_ptr error;
    Clock::time_point at;
  };

  HorizonSweep sweep;
  std::size_t most;
  mutable std::mutex mutex; // of what follows
  std::condition_variable work;
  std::condition_variable done;
  std::map<Key, Held> blocks;
  std::map<Key, Request> requests;
  std::map<Key, Failure> failures;
  std::uint64_t calls = 0;
  std::uint64_t arrivals = 0;
  std::uint64_t sweeps = 0;
  std::uint64_t seen = 0; // change of the pyramid
  bool stopping = false;
  std::vector<std::thread> threads;

  Implementation(HorizonSweep s, std::size_t m) : sweep(std::move(s)), most(m) {
    this->seen = this->sweep.Pyramid()->LatestChange();
  }

  // The rest needs the lock.
  void NoteChanges() {
    ElevationPyramid& pyramid = *this->sweep.Pyramid();
    if (pyramid.LatestChange() == this->seen) {
      return;
    }
    const PyramidChanges changes = pyramid.Changes(this->seen);
    this->seen = changes.stamp;
    for (auto& [key, held] : this->blocks) {
      held.outdated = held.outdated || this->Reads(held.read, changes);
    }
  }

  bool Reads(const std::vector<PostBlock>& read, const PyramidChanges& changes) const {
    const PostLattice& lattice = this->sweep.Pyramid()->Lattice();
    return std::any_of(changes.rectangles.begin(), changes.rectangles.end(),
                       [&](const PostRectangle& changed) {
                         return std::any_of(read.begin(), read.end(), [&](const PostBlock& block) {
                           return Touches(lattice, changed, block);
                         });
                       });
  }

  void Ask(const Key& key, std::size_t rank, Clock::time_point notBefore = {}) {
    Request& request = this->requests[key];
    request.call = this->calls;
    request.rank = rank;
    request.notBefore = notBefore;
  }

  static Clock::time_point After(Clock::time_point from, double seconds) {
    return from +
           std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
  }

  // The latest call's first.
  std::map<Key, Request>::iterator Next() {
    auto best = this->requests.end();
    const Clock::time_point now = Clock::now();
    for (auto it = this->requests.begin(); it != this->requests.end(); ++it) {
      if (it->second.running || it->second.notBefore > now) {
        continue;
      }
      const bool better =
          best == this->requests.end() || it->second.call > best->second.call ||
          (it->second.call == best->second.call && it->second.rank < best->second.rank);
      best = better ? it : best;
    }
    return best;
  }

  void Evict() {
    if (this->blocks.size() <= this->most) {
      return;
    }
    std::vector<std::uint64_t> uses;
    for (const auto& [key, held] : this->blocks) {
      uses.push_back(held.use);
    }
    const auto middle = uses.begin() + std::ptrdiff_t(uses.size() / 4);
    std::nth_element(uses.begin(), middle, uses.end());
    for (auto it = this->blocks.begin(); it != this->blocks.end();) {
      // What the latest call asked for stays.
      it = it->second.use <= *middle && it->second.use < this->calls ? this->blocks.erase(it)
                                                                     : std::next(it);
    }
  }

  void Run() {
    std::unique_lock<std::mutex> lock(this->mutex);
    for (;;) {
      if (this->stopping) {
        return;
      }
      const auto next = this->Next();
      if (next == this->requests.end()) {
        if (this->requests.empty()) {
          this->work.wait(lock);
        } else { // what is there runs elsewhere, or has to rest
          this->work.wait_for(lock, std::chrono::milliseconds(50));
        }
        continue;
      }
      const Key key = next->first;
      next->second.running = true;
      const std::uint64_t before = this->sweep.Pyramid()->LatestChange();
      lock.unlock();
      Held held;
      std::exception_ptr error;
      try {
        held = this->Make(key);
      } catch (...) {
        error = std::current_exception();
      }
      lock.lock();
      ++this->sweeps;
      ++this->arrivals;
      this->requests.erase(key);
      if (error) {
        this->failures[key] = {error, Clock::now()};
      } else {
        this->failures.erase(key);
        this->NoteChanges();
        held.outdated =
            before != this->seen && this->Reads(held.read, this->sweep.Pyramid()->Changes(before));
        held.use = this->calls;
        this->blocks[key] = std::move(held);
        this->Evict();
      }
      this->done.notify_all();
    }
  }

  // Without the lock.
  Held Make(const Key& key) const {
    constexpr std::size_t Posts = std::size_t(Side) * Side;
    auto block = std::make_shared<HorizonBlock>();
    block->all.resize(Posts);
    block->distant.resize(Posts);
    Held held;
    held.read = this->sweep
                    .Sweep({int(key[0]), key[1] * Side, key[2] * Side, Side, Side},
                           double(key[3]) * StepDegrees, block->all.data(), block->distant.data(),
                           ReadSeconds)
                    .read;
    for (std::vector<float>* values : {&block->all, &block->distant}) {
      for (float& v : *values) {
        v = v == HorizonSweep::None ? float(-0.5 * M_PI) : std::atan(v);
      }
    }
    held.block = std::move(block);
    held.swept = Clock::now();
    return held;
  }
};

HorizonBlocks::HorizonBlocks(HorizonSweep sweep, int threads, std::size_t most)
    : Impl_(std::make_unique<Implementation>(std::move(sweep), most)) {
  if (threads < 1 || threads > 64 || most < 64) {
    throw Error(Error::Kind::InvalidArgument, this->Sweep().Pyramid()->Source().GetName(),
                std::to_string(threads) + " threads and " + std::to_string(most) +
                    " blocks of horizons are rejected; accepted are 1 to 64 threads and 64 blocks "
                    "or more");
  }
  for (int i = 0; i < threads; ++i) {
    this->Impl_->threads.emplace_back([impl = this->Impl_.get()] { impl->Run(); });
  }
}

HorizonBlocks::~HorizonBlocks() {
  {
    const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
    this->Impl_->stopping = true;
  }
  this->Impl_->work.notify_all();
  for (std::thread& thread : this->Impl_->threads) {
    thread.join();
  }
}

const HorizonSweep& HorizonBlocks::Sweep() const {
  return this->Impl_->sweep;
}

std::vector<HorizonBlocks::Pointer> HorizonBlocks::TryGet(const std::vector<Key>& keys) {
  Implementation& impl = *this->Impl_;
  std::vector<Pointer> result;
  const std::lock_guard<std::mutex> lock(impl.mutex);
  impl.NoteChanges();
  ++impl.calls;
  for (std::size_t i = 0; i < keys.size(); ++i) {
    const auto found = impl.blocks.find(keys[i]);
    const auto failed = impl.failures.find(keys[i]);
    const bool there = found != impl.blocks.end();
    result.push_back(there ? found->second.block : nullptr);
    if (there) {
      found->second.use = impl.calls;
    }
    if (failed != impl.failures.end()) {
      impl.Ask(keys[i], i, Implementation::After(failed->second.at, RetrySeconds));
    } else if (!there) {
      impl.Ask(keys[i], i);
    } else if (found->second.outdated) {
      impl.Ask(keys[i], i, Implementation::After(found->second.swept, RestSeconds));
    }
  }
  // What was asked for by earlier calls and not since goes, so that the queue stays short.
  for (auto it = impl.requests.begin(); it != impl.requests.end();) {
    const bool old = !it->second.running && it->second.call + 16 < impl.calls;
    it = old ? impl.requests.erase(it) : std::next(it);
  }
  impl.work.notify_all();
  return result;
}

std::vector<HorizonBlocks::Pointer> HorizonBlocks::Get(const std::vector<Key>& keys,
                                                       double seconds) {
  Implementation& impl = *this->Impl_;
  const Clock::time_point end = Implementation::After(Clock::now(), std::min(seconds, 1e6));
  std::vector<Pointer> result(keys.size());
  std::unique_lock<std::mutex> lock(impl.mutex);
  ++impl.calls;
  impl.failures.clear();
  for (;;) {
    impl.NoteChanges();
    bool complete = true;
    for (std::size_t i = 0; i < keys.size(); ++i) {
      const auto found = impl.blocks.find(keys[i]);
      const bool fresh = found != impl.blocks.end() && !found->second.outdated;
      if (found != impl.blocks.end()) {
        found->second.use = impl.calls;
      }
      result[i] = fresh ? found->second.block : nullptr;
      if (fresh) {
        continue;
      }
      const auto failed = impl.failures.find(keys[i]);
      if (failed != impl.failures.end()) {
        std::rethrow_exception(failed->second.error);
      }
      complete = false;
      impl.Ask(keys[i], i);
    }
    if (complete) {
      return result;
    }
    impl.work.notify_all();
    if (impl.done.wait_until(lock, end) == std::cv_status::timeout) {
      throw Error(Error::Kind::DeadlineExceeded, impl.sweep.Pyramid()->Source().GetName(),
                  "its horizons were not there within " + std::to_string(seconds) + " s");
    }
  }
}

std::uint64_t HorizonBlocks::Arrivals() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->arrivals + this->Impl_->sweep.Pyramid()->LatestChange();
}

std::uint64_t HorizonBlocks::Sweeps() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->sweeps;
}

} // namespace dspace
