// Numbered places on the surface, and the lines of the listing.
Object.assign(Page.prototype, {
  makeMarkers() {
    this.markers = this.data.gouges.map((g, k) => {
      const button = document.createElement('button');
      Object.assign(button, {type: 'button', className: 'marker', textContent: k + 1, title: g.text});
      button.addEventListener('click', () => this.showGouge(k, false));
      g.normal = this.normalNear(g.point);
      byId('markers').append(button);
      return button;
    });
  },

  /** Normal of the surface at the grid point nearest to a place; null without a surface. */
  normalNear(point) {
    let best = null, least = Infinity;
    for (let i = 0; this.surface && i < this.surface.count; i++) {
      const p = this.surface.points, away = Math.hypot(p[3 * i] - point[0], p[3 * i + 1] - point[1], p[3 * i + 2] - point[2]);
      if (away < least) { least = away; best = i; }
    }
    return best === null ? null : [...this.surface.normals.subarray(3 * best, 3 * best + 3)];
  },

  placeMarkers() {
    const eye = this.camera.eye();
    const {clientWidth: width, clientHeight: height} = this.view.canvas;
    this.data.gouges.forEach((g, k) => {
      const at = this.view.project(g.point);
      const inside = at && at.x > 0 && at.y > 0 && at.x < width && at.y < height;
      this.markers[k].hidden = !inside;
      this.markers[k].classList.toggle('behind', g.normal !== null && Vec.dot(g.normal, Vec.sub(eye, g.point)) < 0);
      if (inside) this.markers[k].style.transform = `translate(${at.x.toFixed(1)}px, ${at.y.toFixed(1)}px)`;
    });
  },

  /** Tool at the record nearest to the place on that NC line, the row and the line marked. */
  showGouge(k, scrollToView) {
    const g = this.data.gouges[k];
    this.showScene(false);
    for (const row of document.querySelectorAll('tr[data-row]')) row.classList.toggle('current', Number(row.dataset.row) === k);
    this.markers.forEach((m, i) => m.classList.toggle('current', i === k));
    const index = this.paths.findIndex((p) => p.index === g.operation);
    if (index >= 0) {
      const path = this.paths[index];
      let best = -1, least = Infinity;
      const on_line = g.line > 0 && path.lines;
      for (let i = 0; i < path.n; i++) {
        const away = Math.hypot(...Vec.sub(path.tip(i), g.point)) + (on_line ? 1e3 * Math.min(1e3, Math.abs(path.line(i) - g.line)) : 0);
        if (away < least) { least = away; best = i; }
      }
      if (best >= 0) this.goTo(index, best);
    }
    this.markLine(g.line);
    const line = byId(`L${g.line}`);
    if (line) line.scrollIntoView({block: 'nearest'});
    if (scrollToView) byId('space').scrollIntoView({behavior: 'smooth', block: 'start'});
    else if (line) line.closest('section').scrollIntoView({behavior: 'smooth', block: 'nearest'});
    this.dirty = true;
  },

  showLine(line) {
    for (let k = 0; k < this.paths.length; k++) {
      if (!this.paths[k].lines) continue;
      for (let i = 0; i < this.paths[k].n; i++)
        if (this.paths[k].line(i) === line) {
          this.goTo(k, i);
          byId('space').scrollIntoView({behavior: 'smooth', block: 'start'});
          return;
        }
    }
    this.markLine(line);
  },

  goTo(operation, record) {
    this.showScene(false);
    if (operation !== this.state.operation) this.showOperation(operation, false);
    this.showPass(this.path().passOf(record));
    this.showRecord(record);
  },

  markLine(line) {
    const old = document.querySelector('.listing .current');
    if (old) old.classList.remove('current');
    const now = line ? byId(`L${line}`) : null;
    if (now) {
      now.classList.add('current');
      const box = now.closest('.listing');
      if (now.offsetTop < box.scrollTop || now.offsetTop > box.scrollTop + box.clientHeight - 24) box.scrollTop = now.offsetTop - box.clientHeight / 2;
    }
  },
});
