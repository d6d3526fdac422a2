"""Contact fatigue: stress below a rolling and sliding contact, and criteria on its history."""
