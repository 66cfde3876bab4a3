#include <dspace/widgets/scene/SceneTreeModel.h>

#include <algorithm>
#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <utility>
#include <vector>

namespace dspace::widgets {
namespace {

using Key = std::uint64_t; // a frame's id; an object's id with the highest bit set
constexpr Key ObjectBit = Key(1) << 63;

struct Node {
  Key key = 0;
  Node* parent = nullptr;
  int row = 0;
  bool fetched = false; // the children are made
  std::vector<std::unique_ptr<Node>> children;

  bool IsObject() const { return (this->key & ObjectBit) != 0; }
  ObjectId Object() const { return this->IsObject() ? ObjectId(this->key & ~ObjectBit) : 0; }
  FrameId Frame() const { return this->IsObject() ? this->parent->key : this->key; }
};

// Of an object, when the rows were last brought up to date.
struct SeenObject {
  ObjectId id = 0;
  FrameId frame = NoFrame;
  bool visible = true;
  bool fragmentVisible = true;
};

// Objects on a frame and below.
struct ObjectCounts {
  std::uint32_t objects = 0;
  std::uint32_t visible = 0;

  SceneTreeModel::Eye Eye() const {
    using Eye = SceneTreeModel::Eye;
    return this->objects == 0               ? Eye::None
           : this->visible == 0             ? Eye::Hidden
           : this->visible == this->objects ? Eye::Visible
                                            : Eye::Mixed;
  }
};

SceneTreeModel::Icon IconOf(const GraphicsObject& object) {
  using Icon = SceneTreeModel::Icon;
  if (object.custom) {
    return Icon::Drawn;
  }
  if (object.billboard) {
    return Icon::Label;
  }
  if (object.levels.empty() || object.levels.front().parts.empty()) {
    return Icon::Empty;
  }
  Icon icon = Icon::Points;
  for (const Part& part : object.levels.front().parts) {
    const Mesh::Primitive primitive = part.mesh->primitive;
    if (primitive == Mesh::Primitive::Triangles) {
      return Icon::Mesh;
    }
    icon = primitive == Mesh::Primitive::Lines ? Icon::Lines : icon;
  }
  return icon;
}

QString WordFor(SceneTreeModel::Icon icon) {
  switch (icon) {
  case SceneTreeModel::Icon::Frame:
    return "frame";
  case SceneTreeModel::Icon::Mesh:
    return "mesh";
  case SceneTreeModel::Icon::Lines:
    return "lines";
  case SceneTreeModel::Icon::Points:
    return "points";
  case SceneTreeModel::Icon::Label:
    return "label";
  case SceneTreeModel::Icon::Drawn:
    return "drawn";
  case SceneTreeModel::Icon::Empty:
    break;
  }
  return "empty";
}

} // namespace

struct SceneTreeModel::Internals {
  explicit Internals(SceneTreeModel* owner) : model(owner) {}

  SceneTreeModel* model;
  std::shared_ptr<Scene> scene;
  FrameNotifier::Token listener = 0;
  std::function<QString(ObjectId)> kinds;

  Node top; // above the root frame's row
  std::unordered_map<Key, Node*> nodes;

  std::uint64_t contentRevision = 0;
  std::vector<SeenObject> seen; // by id
  std::unordered_map<FrameId, std::vector<ObjectId>> objectsOf;
  std::unordered_map<FrameId, ObjectCounts> counts; // only frames with objects on them or below

  QString filter;
  std::unordered_set<Key> shown; // with a filter
  int matches = 0;

  // What changed since the last Refresh().
  std::unordered_set<FrameId> changedParents;
  std::unordered_set<Key> changedRows;
  bool moved = false;   // a frame was removed or got another parent
  bool renamed = false; // or created

  // --- Scene -------------------------------------------------------------------------------------

  bool Has(FrameId frame) const { return this->scene && this->scene->Frames().Contains(frame); }
  const GraphicsObject* Object(ObjectId id) const {
    if (!this->scene) {
      return nullptr;
    }
    const auto found = this->scene->Objects().find(id);
    return found == this->scene->Objects().end() ? nullptr : &found->second;
  }

  void Listen(const FrameEvent& event) {
    const FrameTree& frames = this->scene->Frames();
    for (const FrameId id : event.ids) {
      const auto node = this->nodes.find(id);
      switch (event.type) {
      case FrameEvent::Type::Created:
      case FrameEvent::Type::Reparented:
      case FrameEvent::Type::Removed:
        this->moved = this->moved || event.type != FrameEvent::Type::Created;
        this->renamed = true;
        if (node != this->nodes.end() && node->second->parent) {
          this->changedParents.insert(node->second->parent->key);
        }
        if (frames.Contains(id)) {
          this->changedParents.insert(frames.Parent(id));
        }
        break;
      case FrameEvent::Type::Renamed:
        this->renamed = true;
        this->changedRows.insert(id);
        break;
      case FrameEvent::Type::PosesChanged:
        return;
      }
    }
  }

  void Leave() {
    if (this->scene && this->listener) {
      this->scene->Frames().RemoveListener(this->listener);
    }
    this->listener = 0;
  }

  // All rows anew.
  void Reset() {
    this->nodes.clear();
    this->top.children.clear();
    this->top.fetched = true;
    this->changedParents.clear();
    this->changedRows.clear();
    this->moved = this->renamed = false;
    this->seen.clear();
    this->objectsOf.clear();
    this->counts.clear();
    this->contentRevision = 0;
    if (!this->scene) {
      this->shown.clear();
      this->matches = 0;
      return;
    }
    this->LookAtObjects();
    this->changedParents.clear();
    this->changedRows.clear();
    this->LookForMatches();
    if (this->IsShown(RootFrame)) {
      this->top.children.push_back(this->Make(&this->top, RootFrame, 0));
    }
  }

  // --- Objects -----------------------------------------------------------------------------------

  void Count(FrameId frame, int objects, int visible) {
    const FrameTree& frames = this->scene->Frames();
    for (; frames.Contains(frame); frame = frames.Parent(frame)) {
      ObjectCounts& count = this->counts[frame];
      const Eye before = count.Eye();
      count.objects += std::uint32_t(objects);
      count.visible += std::uint32_t(visible);
      if (count.Eye() != before) {
        this->changedRows.insert(frame);
      }
      if (count.objects == 0) {
        this->counts.erase(frame);
      }
      if (frame == RootFrame) {
        break;
      }
    }
  }

  void CountAll() {
    const std::unordered_map<FrameId, ObjectCounts> before = std::move(this->counts);
    std::unordered_set<Key> rows = std::move(this->changedRows);
    this->counts.clear();
    this->changedRows.clear();
    // Each frame's own, then towards the root: children come after their parents.
    const FrameTree& frames = this->scene->Frames();
    for (const SeenObject& object : this->seen) {
      ObjectCounts& count = this->counts[object.frame];
      ++count.objects;
      count.visible += object.visible ? 1 : 0;
    }
    for (std::size_t slot = frames.Size(); slot-- > 1;) {
      const FrameId id = frames.IdAt(slot);
      const auto own = this->counts.find(id);
      if (own != this->counts.end()) {
        const ObjectCounts added = own->second;
        ObjectCounts& above = this->counts[frames.Parent(id)];
        above.objects += added.objects;
        above.visible += added.visible;
      }
    }
    for (const auto& entry : this->counts) {
      const auto old = before.find(entry.first);
      if (old == before.end() || old->second.Eye() != entry.second.Eye()) {
        rows.insert(entry.first);
      }
    }
    for (const auto& entry : before) {
      if (!this->counts.count(entry.first)) {
        rows.insert(entry.first);
      }
    }
    this->changedRows = std::move(rows);
  }

  void Detach(const SeenObject& object) {
    const auto found = this->objectsOf.find(object.frame);
    if (found != this->objectsOf.end()) {
      std::vector<ObjectId>& ids = found->second;
      ids.erase(std::remove(ids.begin(), ids.end(), object.id), ids.end());
      if (ids.empty()) {
        this->objectsOf.erase(found);
      }
    }
    this->changedParents.insert(object.frame);
  }
  void Attach(const SeenObject& object) {
    std::vector<ObjectId>& ids = this->objectsOf[object.frame];
    ids.insert(std::lower_bound(ids.begin(), ids.end(), object.id), object.id);
    this->changedParents.insert(object.frame);
  }

  // Compares the scene's objects with those that were seen.
  void LookAtObjects() {
    const bool anew = this->scene->ContentRevision() != this->contentRevision;
    if (!anew && !this->moved) {
      return;
    }
    this->contentRevision = this->scene->ContentRevision();
    std::set<std::string> hidden;
    const SceneFragmentManager& fragments = this->scene->Fragments();
    for (const std::string& name : fragments.Names()) {
      if (!fragments.Get(name).visible) {
        hidden.insert(name);
      }
    }
    const bool countLater = this->moved || this->seen.empty();
    const auto count = [&](FrameId frame, int objects, int visible) {
      if (!countLater) {
        this->Count(frame, objects, visible);
      }
    };
    std::vector<SeenObject> now;
    now.reserve(this->scene->Objects().size());
    auto old = this->seen.begin();
    const auto drop = [&] {
      this->Detach(*old);
      count(old->frame, -1, old->visible ? -1 : 0);
      ++old;
    };
    for (const auto& [id, object] : this->scene->Objects()) {
      const SeenObject next{id, object.frame, object.visible,
                            hidden.empty() || !hidden.count(object.fragment)};
      while (old != this->seen.end() && old->id < id) {
        drop();
      }
      if (old != this->seen.end() && old->id == id) {
        if (old->frame != next.frame) {
          this->Detach(*old);
          this->Attach(next);
          count(old->frame, -1, old->visible ? -1 : 0);
          count(next.frame, 1, next.visible ? 1 : 0);
        } else if (old->visible != next.visible) {
          count(next.frame, 0, next.visible ? 1 : -1);
        }
        if (old->visible != next.visible || old->fragmentVisible != next.fragmentVisible) {
          this->changedRows.insert(id | ObjectBit);
        }
        ++old;
      } else {
        this->Attach(next);
        this->renamed = true; // the filter may show it
        count(next.frame, 1, next.visible ? 1 : 0);
      }
      now.push_back(next);
    }
    while (old != this->seen.end()) {
      drop();
    }
    this->seen = std::move(now);
    if (countLater) {
      this->CountAll();
    }
  }

  const SeenObject* Seen(ObjectId id) const {
    const auto found =
        std::lower_bound(this->seen.begin(), this->seen.end(), id,
                         [](const SeenObject& a, ObjectId wanted) { return a.id < wanted; });
    return found != this->seen.end() && found->id == id ? &*found : nullptr;
  }

  // --- Filter ------------------------------------------------------------------------------------

  bool IsShown(Key key) const { return this->filter.isEmpty() || this->shown.count(key) != 0; }

  void LookForMatches() {
    this->shown.clear();
    this->matches = 0;
    if (this->filter.isEmpty() || !this->scene) {
      return;
    }
    const FrameTree& frames = this->scene->Frames();
    const auto fits = [&](const std::string& name) {
      return QString::fromUtf8(name.data(), qsizetype(name.size()))
          .contains(this->filter, Qt::CaseInsensitive);
    };
    const auto show = [&](FrameId frame) {
      for (; this->shown.insert(frame).second && frame != RootFrame; frame = frames.Parent(frame)) {
      }
    };
    for (std::size_t slot = 0; slot < frames.Size(); ++slot) {
      const FrameId id = frames.IdAt(slot);
      if (fits(frames.Name(id))) {
        ++this->matches;
        show(id);
      }
    }
    for (const auto& [id, object] : this->scene->Objects()) {
      if (fits(object.name)) {
        ++this->matches;
        this->shown.insert(id | ObjectBit);
        show(object.frame);
      }
    }
  }

  // --- Rows --------------------------------------------------------------------------------------

  QModelIndex IndexOf(const Node& node, int column = 0) const {
    return &node == &this->top
               ? QModelIndex()
               : this->model->createIndex(node.row, column, const_cast<Node*>(&node));
  }
  static Node* NodeOf(const QModelIndex& index) {
    return static_cast<Node*>(index.internalPointer());
  }
  Node* Find(Key key) const {
    const auto found = this->nodes.find(key);
    return found == this->nodes.end() ? nullptr : found->second;
  }

  std::unique_ptr<Node> Make(Node* parent, Key key, int row) {
    auto node = std::make_unique<Node>();
    node->key = key;
    node->parent = parent;
    node->row = row;
    this->nodes[key] = node.get();
    node->fetched = !this->HasRows(*node);
    return node;
  }
  void Forget(const Node& node) {
    for (const auto& child : node.children) {
      this->Forget(*child);
    }
    const auto found = this->nodes.find(node.key);
    if (found != this->nodes.end() && found->second == &node) {
      this->nodes.erase(found);
    }
  }

  // The rows below a node as the scene has them.
  std::vector<Key> Wanted(const Node& node) const {
    std::vector<Key> keys;
    if (node.IsObject() || !this->Has(node.key)) {
      return keys;
    }
    const auto objects = this->objectsOf.find(node.key);
    if (objects != this->objectsOf.end()) {
      for (const ObjectId id : objects->second) {
        if (this->IsShown(id | ObjectBit)) {
          keys.push_back(id | ObjectBit);
        }
      }
    }
    const std::vector<FrameId>& children = this->scene->Frames().Children(node.key);
    keys.reserve(keys.size() + children.size());
    for (const FrameId id : children) {
      if (this->IsShown(id)) {
        keys.push_back(id);
      }
    }
    return keys;
  }
  bool HasRows(const Node& node) const {
    if (node.IsObject() || !this->Has(node.key)) {
      return false;
    }
    const auto objects = this->objectsOf.find(node.key);
    const std::vector<FrameId>& children = this->scene->Frames().Children(node.key);
    if (this->filter.isEmpty()) {
      return objects != this->objectsOf.end() || !children.empty();
    }
    return (objects != this->objectsOf.end() &&
            std::any_of(objects->second.begin(), objects->second.end(),
                        [this](ObjectId id) { return this->IsShown(id | ObjectBit); })) ||
           std::any_of(children.begin(), children.end(),
                       [this](FrameId id) { return this->IsShown(id); });
  }

  void Number(Node& node, std::size_t from) {
    for (std::size_t i = from; i < node.children.size(); ++i) {
      node.children[i]->row = int(i);
    }
  }

  // Removes rows that are gone or stand in another order.
  bool RemoveRows(Node& node, const std::vector<Key>& wanted) {
    auto& rows = node.children;
    std::size_t same = 0;
    while (same < rows.size() && same < wanted.size() && rows[same]->key == wanted[same]) {
      ++same;
    }
    if (same == rows.size()) {
      return false;
    }
    std::unordered_map<Key, std::size_t> places;
    for (std::size_t i = same; i < wanted.size(); ++i) {
      places[wanted[i]] = i;
    }
    std::vector<bool> stays(rows.size() - same, false);
    std::size_t next = same;
    for (std::size_t i = same; i < rows.size(); ++i) {
      const auto place = places.find(rows[i]->key);
      if (place != places.end() && place->second >= next) {
        stays[i - same] = true;
        next = place->second + 1;
      }
    }
    bool any = false;
    for (std::size_t end = rows.size(); end > same;) {
      if (stays[end - 1 - same]) {
        --end;
        continue;
      }
      std::size_t begin = end - 1;
      while (begin > same && !stays[begin - 1 - same]) {
        --begin;
      }
      this->model->beginRemoveRows(this->IndexOf(node), int(begin), int(end) - 1);
      for (std::size_t i = begin; i < end; ++i) {
        this->Forget(*rows[i]);
      }
      rows.erase(rows.begin() + std::ptrdiff_t(begin), rows.begin() + std::ptrdiff_t(end));
      this->Number(node, begin);
      this->model->endRemoveRows();
      any = true;
      end = begin;
    }
    return any;
  }

  // After RemoveRows(), whose rows are a part of `wanted` in its order.
  bool InsertRows(Node& node, const std::vector<Key>& wanted) {
    auto& rows = node.children;
    bool any = false;
    for (std::size_t at = 0; at < wanted.size();) {
      if (at < rows.size() && rows[at]->key == wanted[at]) {
        ++at;
        continue;
      }
      std::size_t end = at + 1;
      while (end < wanted.size() && (at >= rows.size() || rows[at]->key != wanted[end])) {
        ++end;
      }
      this->model->beginInsertRows(this->IndexOf(node), int(at), int(end) - 1);
      std::vector<std::unique_ptr<Node>> made;
      made.reserve(end - at);
      for (std::size_t i = at; i < end; ++i) {
        made.push_back(this->Make(&node, wanted[i], int(i)));
      }
      rows.insert(rows.begin() + std::ptrdiff_t(at), std::make_move_iterator(made.begin()),
                  std::make_move_iterator(made.end()));
      this->Number(node, end);
      this->model->endInsertRows();
      any = true;
      at = end;
    }
    return any;
  }

  // Brings the rows below these frames up to date; first what goes, since a frame may have moved
  // from one to another.
  bool Update(const std::vector<Key>& parents) {
    bool any = false;
    for (const Key key : parents) {
      if (Node* node = this->Find(key); node && node->fetched) {
        any = this->RemoveRows(*node, this->Wanted(*node)) || any;
      }
    }
    for (const Key key : parents) {
      Node* node = this->Find(key);
      if (node && node->fetched) {
        any = this->InsertRows(*node, this->Wanted(*node)) || any;
      } else if (node && !this->HasRows(*node)) {
        // The view learns that there is nothing to open any more.
        const QList<QPersistentModelIndex> above = {this->IndexOf(*node->parent)};
        emit this->model->layoutAboutToBeChanged(above);
        node->fetched = true;
        emit this->model->layoutChanged(above);
        any = true;
      }
    }
    return any;
  }

  // Tells the views of rows, those beside each other at once.
  bool Tell(const std::unordered_set<Key>& keys) {
    std::vector<const Node*> rows;
    rows.reserve(keys.size());
    for (const Key key : keys) {
      if (const Node* node = this->Find(key)) {
        rows.push_back(node);
      }
    }
    std::sort(rows.begin(), rows.end(), [](const Node* a, const Node* b) {
      return a->parent != b->parent ? std::less<const Node*>()(a->parent, b->parent)
                                    : a->row < b->row;
    });
    for (std::size_t first = 0; first < rows.size();) {
      std::size_t last = first;
      while (last + 1 < rows.size() && rows[last + 1]->parent == rows[first]->parent &&
             rows[last + 1]->row == rows[last]->row + 1) {
        ++last;
      }
      emit this->model->dataChanged(this->IndexOf(*rows[first]),
                                    this->IndexOf(*rows[last], ColumnCount - 1));
      first = last + 1;
    }
    return !rows.empty();
  }
};

SceneTreeModel::SceneTreeModel(QObject* parent)
    : QAbstractItemModel(parent), Impl_(std::make_unique<Internals>(this)) {
  this->Impl_->Reset();
}

SceneTreeModel::~SceneTreeModel() {
  this->Impl_->Leave();
}

void SceneTreeModel::SetScene(std::shared_ptr<Scene> scene) {
  Internals& self = *this->Impl_;
  if (scene == self.scene) {
    return;
  }
  this->beginResetModel();
  self.Leave();
  self.scene = std::move(scene);
  if (self.scene) {
    self.listener =
        self.scene->Frames().AddListener([&self](const FrameEvent& event) { self.Listen(event); });
  }
  self.Reset();
  this->endResetModel();
}

const std::shared_ptr<Scene>& SceneTreeModel::GetScene() const {
  return this->Impl_->scene;
}

void SceneTreeModel::SetFilter(const QString& text) {
  Internals& self = *this->Impl_;
  const QString filter = text.trimmed();
  if (filter == self.filter) {
    return;
  }
  this->beginResetModel();
  self.filter = filter;
  self.Reset();
  this->endResetModel();
}

int SceneTreeModel::Matches() const {
  return this->Impl_->matches;
}

void SceneTreeModel::SetKinds(std::function<QString(ObjectId)> kinds) {
  this->Impl_->kinds = std::move(kinds);
}

bool SceneTreeModel::Refresh() {
  Internals& self = *this->Impl_;
  if (!self.scene) {
    return false;
  }
  self.LookAtObjects();
  if (self.changedParents.empty() && self.changedRows.empty() && !self.moved && !self.renamed) {
    return false;
  }
  std::unordered_set<FrameId> parents = std::move(self.changedParents);
  const std::unordered_set<Key> rows = std::move(self.changedRows);
  self.changedParents.clear();
  self.changedRows.clear();
  const bool moved = std::exchange(self.moved, false);
  const bool renamed = std::exchange(self.renamed, false);
  bool any = false;
  if (!self.filter.isEmpty()) {
    if (moved || renamed || !parents.empty()) {
      self.LookForMatches();
      const bool root = self.IsShown(RootFrame);
      if (root != !self.top.children.empty()) {
        this->beginResetModel();
        self.Reset();
        this->endResetModel();
        return true;
      }
      for (const auto& entry : self.nodes) { // a match may show or hide rows anywhere
        if (!entry.second->IsObject()) {
          parents.insert(entry.first);
        }
      }
    }
  } else if (moved) { // where a frame left a parent that was never opened
    for (const auto& entry : self.nodes) {
      if (!entry.second->fetched) {
        parents.insert(entry.first);
      }
    }
  }
  any = self.Update({parents.begin(), parents.end()});
  return self.Tell(rows) || any;
}

SceneItem SceneTreeModel::ItemOf(const QModelIndex& index) const {
  const Node* node = index.isValid() ? Internals::NodeOf(index) : nullptr;
  return node ? SceneItem{node->Frame(), node->Object()} : SceneItem{};
}

QModelIndex SceneTreeModel::IndexOf(const SceneItem& item) {
  Internals& self = *this->Impl_;
  this->Refresh();
  const FrameTree* frames = self.scene ? &self.scene->Frames() : nullptr;
  if (!frames || !frames->Contains(item.frame)) {
    return {};
  }
  std::vector<FrameId> way = {item.frame};
  while (way.back() != RootFrame) {
    way.push_back(frames->Parent(way.back()));
  }
  for (auto frame = way.rbegin(); frame != way.rend(); ++frame) {
    Node* node = self.Find(*frame);
    if (!node) {
      return {};
    }
    if (*frame != item.frame || item.object != 0) {
      this->fetchMore(self.IndexOf(*node));
    }
  }
  const Node* node = self.Find(item.object != 0 ? item.object | ObjectBit : item.frame);
  return node ? self.IndexOf(*node) : QModelIndex();
}

SceneTreeModel::Eye SceneTreeModel::EyeOf(const SceneItem& item) const {
  const Internals& self = *this->Impl_;
  if (item.object != 0) {
    const SeenObject* seen = self.Seen(item.object);
    return !seen ? Eye::None : seen->visible ? Eye::Visible : Eye::Hidden;
  }
  const auto found = self.counts.find(item.frame);
  return found == self.counts.end() ? Eye::None : found->second.Eye();
}

QString SceneTreeModel::KindOf(const SceneItem& item) const {
  const Internals& self = *this->Impl_;
  if (item.object == 0) {
    return WordFor(Icon::Frame);
  }
  const GraphicsObject* object = self.Object(item.object);
  if (!object) {
    return {};
  }
  const QString word = self.kinds ? self.kinds(item.object) : QString();
  return word.isEmpty() ? WordFor(IconOf(*object)) : word;
}

QModelIndex SceneTreeModel::index(int row, int column, const QModelIndex& parent) const {
  const Internals& self = *this->Impl_;
  if (parent.isValid() && parent.column() != 0) {
    return {};
  }
  const Node& node = parent.isValid() ? *Internals::NodeOf(parent) : self.top;
  if (row < 0 || std::size_t(row) >= node.children.size() || column < 0 || column >= ColumnCount) {
    return {};
  }
  return this->createIndex(row, column, node.children[std::size_t(row)].get());
}

QModelIndex SceneTreeModel::parent(const QModelIndex& index) const {
  return index.isValid() ? this->Impl_->IndexOf(*Internals::NodeOf(index)->parent) : QModelIndex();
}

int SceneTreeModel::rowCount(const QModelIndex& parent) const {
  if (parent.isValid() && parent.column() != 0) {
    return 0;
  }
  const Node& node = parent.isValid() ? *Internals::NodeOf(parent) : this->Impl_->top;
  return int(node.children.size());
}

int SceneTreeModel::columnCount(const QModelIndex&) const {
  return ColumnCount;
}

bool SceneTreeModel::hasChildren(const QModelIndex& parent) const {
  return this->rowCount(parent) > 0 || this->canFetchMore(parent);
}

bool SceneTreeModel::canFetchMore(const QModelIndex& parent) const {
  return parent.isValid() && parent.column() == 0 && !Internals::NodeOf(parent)->fetched;
}

void SceneTreeModel::fetchMore(const QModelIndex& parent) {
  if (!this->canFetchMore(parent)) {
    return;
  }
  Node& node = *Internals::NodeOf(parent);
  node.fetched = true;
  this->Impl_->InsertRows(node, this->Impl_->Wanted(node));
}

QVariant SceneTreeModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid()) {
    return {};
  }
  // The scene may have changed since the last Refresh(): the row's frame or object may be gone.
  const Internals& self = *this->Impl_;
  const Node& node = *Internals::NodeOf(index);
  const GraphicsObject* object = node.IsObject() ? self.Object(node.Object()) : nullptr;
  if (node.IsObject() ? !object : !self.Has(node.key)) {
    return {};
  }
  const SceneItem item{node.Frame(), node.Object()};
  switch (role) {
  case Qt::DisplayRole:
    switch (index.column()) {
    case NameColumn:
      return QString::fromStdString(object ? object->name : self.scene->Frames().Name(item.frame));
    case NatureColumn:
      return !object                              ? QString()
             : object->nature == Nature::Physical ? QString("physical")
                                                  : QString("ornamental");
    case KindColumn:
      return this->KindOf(item);
    default:
      return {};
    }
  case Qt::ToolTipRole: {
    if (index.column() == VisibleColumn) {
      const SeenObject* seen = object ? self.Seen(item.object) : nullptr;
      if (seen && !seen->fragmentVisible) {
        return QString("Fragment '%1' is hidden").arg(QString::fromStdString(object->fragment));
      }
      const Eye eye = this->EyeOf(item);
      return eye == Eye::None     ? QString("No objects on this frame or below")
             : eye == Eye::Hidden ? QString("Hidden. Click to show")
             : eye == Eye::Mixed  ? QString("Partly visible. Click to show all")
                                  : QString("Visible. Click to hide");
    }
    const QString path = QString::fromStdString(
        self.Has(item.frame) ? self.scene->Frames().Path(item.frame) : std::string());
    return object ? QString("%1 on %2").arg(QString::fromStdString(object->name), path) : path;
  }
  case Qt::AccessibleTextRole:
    if (index.column() == VisibleColumn) {
      const Eye eye = this->EyeOf(item);
      return eye == Eye::None     ? QString()
             : eye == Eye::Hidden ? QString("hidden")
             : eye == Eye::Mixed  ? QString("partly visible")
                                  : QString("visible");
    }
    return {};
  case EyeRole:
    return int(this->EyeOf(item));
  case IconRole:
    return int(object ? IconOf(*object) : Icon::Frame);
  case DimmedRole: {
    const SeenObject* seen = object ? self.Seen(item.object) : nullptr;
    return seen ? !seen->visible || !seen->fragmentVisible : this->EyeOf(item) == Eye::Hidden;
  }
  default:
    return {};
  }
}

QVariant SceneTreeModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal) {
    return {};
  }
  static const char* const names[ColumnCount] = {"Name", "", "Nature", "Kind"};
  static const char* const tips[ColumnCount] = {
      "Frames, and the objects on them", "Whether objects are visible",
      "Physical objects are visible to a real camera, ornamental ones only help a person",
      "What the row is"};
  if (section < 0 || section >= ColumnCount) {
    return {};
  }
  return role == Qt::DisplayRole   ? QVariant(QString(names[section]))
         : role == Qt::ToolTipRole ? QVariant(QString(tips[section]))
                                   : QVariant();
}

} // namespace dspace::widgets
