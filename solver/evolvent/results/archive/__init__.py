"""Files of a run that later runs read: results, error bars, cost, scene, the manifest of files and the lock."""
