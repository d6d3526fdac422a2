"""What pairs in motion cost: vibration over the speed, transient contact."""
