// Opens the page: data, view, page.
(async () => {
  const data = JSON.parse(byId('report-data').textContent);
  const say = (text) => {
    byId('message').textContent = text;
    byId('message').hidden = false;
    byId('controls').hidden = true;
    for (const id of ['legend', 'scale', 'triad']) byId(id).style.display = 'none';
  };
  let title = data.title;
  if (data.grids.length || data.paths.length || data.machine) {
    try {
      const view = new View(byId('view'));
      const surface = data.grids.length ? await loadSurface(data) : null;
      const paths = await Promise.all(data.paths.map(loadPath));
      if (surface) view.setSurface(surface.points, surface.normals, surface.triangles);
      for (const path of paths) view.addPath(path.records);
      for (const tool of data.tools) view.addTool(tool.bodies);
      const machine = data.machine ? await loadMachine(data.machine) : null;
      window.toothpathPage = new Page(data, surface, paths, view, machine);
    } catch (error) {
      say(error.message === 'no WebGL2' ? 'The 3D view needs a browser with WebGL 2. Plots and tables below are complete without it.'
                                        : `The 3D view stopped: ${error.message}`);
      title += ' (no 3D view)';
      if (error.message !== 'no WebGL2') console.error(error);
    }
  }
  document.title = title;
})();
