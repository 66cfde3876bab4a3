// A cache of values by key that evicts the least recently used one.
#ifndef DSPACE_TERRAIN_LRUCACHE_H
#define DSPACE_TERRAIN_LRUCACHE_H

#include <cstddef>
#include <iterator>
#include <list>
#include <map>
#include <utility>

namespace dspace {

// Not synchronised: the owner locks.
template<typename Key, typename Value> class LruCache {
public:
  explicit LruCache(std::size_t most) : Most_(most) {}

  // The value, which becomes the most recently used; null if absent. Valid until the next call of
  // another function.
  const Value* Find(const Key& key) {
    const auto found = this->Entries_.find(key);
    if (found == this->Entries_.end()) {
      return nullptr;
    }
    this->Uses_.splice(this->Uses_.begin(), this->Uses_, found->second.use);
    return &found->second.value;
  }

  // Inserts a value and may evict another. An existing value of the key stays.
  void Insert(const Key& key, Value value) {
    if (this->Find(key)) {
      return;
    }
    this->Uses_.push_front(key);
    this->Entries_.emplace(key, Entry{std::move(value), this->Uses_.begin()});
    if (this->Uses_.size() > this->Most_) {
      this->Entries_.erase(this->Uses_.back());
      this->Uses_.pop_back();
    }
  }

  template<typename Predicate> void EraseIf(const Predicate& drop) {
    for (auto it = this->Entries_.begin(); it != this->Entries_.end();) {
      if (drop(it->first)) {
        this->Uses_.erase(it->second.use);
        it = this->Entries_.erase(it);
      } else {
        ++it;
      }
    }
  }

private:
  struct Entry {
    Value value;
    typename std::list<Key>::iterator use;
  };
  std::size_t Most_;
  std::map<Key, Entry> Entries_;
  std::list<Key> Uses_; // most recent first
};

} // namespace dspace

#endif
